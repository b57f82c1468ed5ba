//! How much of a run fits into the time that it has.

use crate::case::{Matter, OpenItem, Severity};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// The time that a run has, and how many pieces of evidence it was too short for.
#[derive(Debug)]
pub struct Budget {
    /// When it ends, and its seconds; nothing if there is no limit.
    end: Option<(Instant, u64)>,
    left: AtomicUsize,
}

impl Budget {
    /// So many seconds from `start`.
    pub fn new(seconds: Option<u64>, start: Instant) -> Self {
        let end = seconds.and_then(|seconds| Some((start.checked_add(Duration::from_secs(seconds))?, seconds)));
        Self { end, left: AtomicUsize::new(0) }
    }

    /// Whether there is a limit: then what tells most comes first.
    pub fn is_limited(&self) -> bool {
        self.end.is_some()
    }

    /// The first of `items`, in their order, that end in time when so many run at once; `cost` says how many seconds of a processor each takes.
    pub fn affordable<T>(&self, items: Vec<T>, jobs: usize, cost: impl Fn(&T) -> f64) -> Vec<T> {
        let Some((end, _)) = self.end else { return items };
        let remaining = end.saturating_duration_since(Instant::now()).as_secs_f64();
        let all = items.len();
        let mut free = remaining * f64::from(u32::try_from(jobs).unwrap_or(u32::MAX));
        let fitting = items.into_iter().filter(|item| {
            let cost = cost(item);
            let fits = cost <= remaining && cost <= free;
            free -= if fits { cost } else { 0.0 };
            fits
        });
        let fitting: Vec<T> = fitting.collect();
        self.left.fetch_add(all - fitting.len(), Ordering::Relaxed);
        fitting
    }

    /// What the page says of the rest.
    pub fn open_item(&self) -> Option<OpenItem> {
        let left = self.left.load(Ordering::Relaxed);
        let (_, seconds) = self.end.filter(|_| left > 0)?;
        Some(OpenItem {
            severity: Severity::Open,
            matter: Matter::Limit,
            about: "run".to_owned(),
            text: format!(
                "{left} pieces of evidence were not run: they would not have ended within {seconds} s (--within). \
                 The same command again, on the same commit, goes on from here."
            ),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Budget;
    use std::time::Instant;

    #[test]
    fn without_a_limit_everything_fits() {
        let budget = Budget::new(None, Instant::now());
        assert_eq!(budget.affordable(vec![1e9, 2e9], 1, |cost| *cost), [1e9, 2e9]);
        assert!(budget.open_item().is_none() && !budget.is_limited());
    }

    #[test]
    fn what_does_not_fit_is_counted_and_told() {
        let budget = Budget::new(Some(100), Instant::now());
        let fitting = budget.affordable(vec![90.0, 150.0, 80.0, 60.0, 10.0], 2, |cost| *cost);
        assert_eq!(fitting, [90.0, 80.0, 10.0], "two processors have 200 s, and nothing ends in time that takes 150 s");
        let item = budget.open_item().expect("two are left");
        assert!(item.text.starts_with("2 pieces of evidence were not run") && item.text.contains("within 100 s"));
        let over = Budget::new(Some(0), Instant::now());
        assert!(over.affordable(vec![1.0], 2, |cost| *cost).is_empty());
    }
}
