//! Least squares for a broken line: at most 17 unknowns.

/// The normal equations of a broken line: N·knots = b.
pub(super) struct Normal {
    matrix: Vec<Vec<f64>>,
    right: Vec<f64>,
}

impl Normal {
    /// Of `count` knots, from measurements: the span, the part of it that is gone by, and the value.
    pub(super) fn new(count: usize, rows: impl Iterator<Item = (usize, f64, f64)>) -> Self {
        let (mut matrix, mut right) = (vec![vec![0.0; count]; count], vec![0.0; count]);
        for (k, part, value) in rows {
            let weights = [1.0 - part, part];
            for (i, a) in weights.into_iter().enumerate() {
                right[k + i] += a * value;
                for (j, b) in weights.into_iter().enumerate() {
                    matrix[k + i][k + j] += a * b;
                }
            }
        }
        Self { matrix, right }
    }

    /// The knots; none if the measurements do not determine them.
    pub(super) fn solve(&self) -> Option<Vec<f64>> {
        let inverse = self.inverse()?;
        Some(inverse.iter().map(|row| row.iter().zip(&self.right).map(|(a, b)| a * b).sum()).collect())
    }

    /// The inverse of the matrix, by elimination with the largest pivot.
    pub(super) fn inverse(&self) -> Option<Vec<Vec<f64>>> {
        let count = self.right.len();
        let unit = |i: usize| (0..count).map(move |j| if i == j { 1.0 } else { 0.0 });
        let mut rows: Vec<Vec<f64>> =
            self.matrix.iter().enumerate().map(|(i, row)| row.iter().copied().chain(unit(i)).collect()).collect();
        let scale = self.matrix.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
        for column in 0..count {
            let pivot = (column..count).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()))?;
            let size = rows[pivot][column].abs();
            if size.is_nan() || size <= scale * 1e-12 {
                return None;
            }
            rows.swap(column, pivot);
            let factor = rows[column][column];
            rows[column].iter_mut().for_each(|value| *value /= factor);
            let pivot_row = rows[column].clone();
            for (place, row) in rows.iter_mut().enumerate() {
                if place != column {
                    let factor = row[column];
                    row.iter_mut().zip(&pivot_row).for_each(|(value, above)| *value -= factor * above);
                }
            }
        }
        Some(rows.into_iter().map(|row| row[count..].to_vec()).collect())
    }

    /// The knots of a line that nowhere falls: neighbours that fall become one, until none does.
    pub(super) fn rising(&self) -> Option<Vec<f64>> {
        // Which of the unknowns each knot is.
        let mut of: Vec<usize> = (0..self.right.len()).collect();
        loop {
            let count = of.last()? + 1;
            let mut pooled = Self { matrix: vec![vec![0.0; count]; count], right: vec![0.0; count] };
            for (i, &group) in of.iter().enumerate() {
                pooled.right[group] += self.right[i];
                for (j, &other) in of.iter().enumerate() {
                    pooled.matrix[group][other] += self.matrix[i][j];
                }
            }
            let values = pooled.solve()?;
            let falls: Vec<bool> = values.windows(2).map(|pair| pair[0] > pair[1]).collect();
            if !falls.contains(&true) {
                return Some(of.iter().map(|&group| values[group]).collect());
            }
            // The new number of each unknown: one less for every fall before it.
            let mut gone = 0;
            let mut renamed = vec![0];
            for (place, fall) in falls.iter().enumerate() {
                gone += usize::from(*fall);
                renamed.push(place + 1 - gone);
            }
            for group in &mut of {
                *group = renamed[*group];
            }
        }
    }
}
