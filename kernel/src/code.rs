//! Analog codes: which speed two code frequencies name (JP4845985B2).
//!
//! The envelope of each carrier swings at a *code frequency*. The receiver measures it; here it becomes a code, and two
//! codes, of the main and of the sub carrier, become a permitted speed. A frequency beside every band and a pair that
//! names nothing are no signal.
//!
//! Requirements: `spec/code.md`, CODE-1 to CODE-4.

use crate::speed::KmhTenths;

/// The most codes that a carrier may have.
pub const MAX_CODES: usize = 8;

/// A frequency in thousandths of a hertz.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Millihertz(pub u32);

/// One code of a carrier: its place among the carrier's code frequencies, 0 to 7.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(u8);

impl Code {
    /// The code at `place`; `None` from 8 on.
    pub const fn new(place: u8) -> Option<Self> {
        if (place as usize) < MAX_CODES { Some(Self(place)) } else { None }
    }

    /// Its place, 0 to 7.
    pub const fn place(self) -> u8 {
        self.0
    }
}

/// The code frequencies of one carrier, checked: 1 to 8, strictly rising, with a band around each; bands do not touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodeFrequencies {
    nominal: [Millihertz; MAX_CODES],
    count: u8,
    tolerance: Millihertz,
}

/// The speeds that pairs of codes name, checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodeTable {
    main: CodeFrequencies,
    sub: CodeFrequencies,
    speeds: [[Option<KmhTenths>; MAX_CODES]; MAX_CODES],
}

/// Which rule code frequencies or a code table break. Source: `spec/code.md`, CODE-3 and CODE-4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeError {
    /// There is no code frequency.
    NoFrequency,
    /// There are more than 8.
    TooManyFrequencies,
    /// The band of the first frequency reaches down to 0, or the band of the last one is beyond what can be written.
    OutOfRange,
    /// The band at this place (from 0) touches the one before it, or is not above it.
    BandsTouch(usize),
    /// The table names no speed.
    NoSpeed,
    /// A speed stands at a main code (first) and a sub code (second) of which one is not in use.
    UnusedCode(usize, usize),
}

impl CodeFrequencies {
    /// Checks and keeps the frequencies, the lowest first; a measured frequency may be off by `tolerance`.
    ///
    /// # Errors
    /// The first rule that is broken, in the order of [`CodeError`].
    pub fn new(nominal: &[Millihertz], tolerance: Millihertz) -> Result<Self, CodeError> {
        //= spec/code.md#code-3-the-frequencies
        //# Code frequencies MUST be rejected if there are none or more than 8, if a band reaches 0 or beyond the highest number, or if a band touches the one before it.
        let (Some(first), Some(last)) = (nominal.first(), nominal.last()) else {
            return Err(CodeError::NoFrequency);
        };
        if nominal.len() > MAX_CODES {
            return Err(CodeError::TooManyFrequencies);
        }
        if first.0 <= tolerance.0 || last.0.checked_add(tolerance.0).is_none() {
            return Err(CodeError::OutOfRange);
        }
        let mut kept = Self { nominal: [Millihertz(0); MAX_CODES], count: 0, tolerance };
        for (place, frequency) in nominal.iter().enumerate() {
            if place > 0 {
                // Both differences are of frequencies that were found to be above the tolerance.
                let top = nominal[place - 1].0.saturating_add(tolerance.0);
                if frequency.0 <= top || frequency.0 - top <= tolerance.0 {
                    return Err(CodeError::BandsTouch(place));
                }
            }
            kept.nominal[place] = *frequency;
            kept.count += 1;
        }
        Ok(kept)
    }

    /// The frequencies, the lowest first: 1 to 8 of them.
    pub fn nominal(&self) -> &[Millihertz] {
        &self.nominal[..usize::from(self.count)]
    }

    /// By how much a measured frequency may be off.
    pub const fn tolerance(&self) -> Millihertz {
        self.tolerance
    }

    /// The code in whose band `measured` is; `None` if it is in none.
    pub const fn identify(&self, measured: Millihertz) -> Option<Code> {
        //= spec/code.md#code-1-the-bands
        //# A measured frequency MUST be taken for a code if and only if it is within the tolerance of that code's frequency.
        let mut place = 0;
        let mut code = None;
        while place < MAX_CODES {
            let used = place < self.count as usize;
            if used && measured.0.abs_diff(self.nominal[place].0) <= self.tolerance.0 {
                code = Some(Code(place.to_le_bytes()[0]));
            }
            place += 1;
        }
        code
    }
}

impl CodeTable {
    /// Checks and keeps the speeds: `speeds[main][sub]`.
    ///
    /// # Errors
    /// [`CodeError::NoSpeed`] or [`CodeError::UnusedCode`].
    pub fn new(
        main: CodeFrequencies,
        sub: CodeFrequencies,
        speeds: [[Option<KmhTenths>; MAX_CODES]; MAX_CODES],
    ) -> Result<Self, CodeError> {
        //= spec/code.md#code-4-the-table
        //# A code table MUST be rejected if it names no speed, or one for a code that is not in use.
        let mut any = false;
        for (row, of_main) in speeds.iter().enumerate() {
            for (column, speed) in of_main.iter().enumerate() {
                any |= speed.is_some();
                if speed.is_some() && (row >= usize::from(main.count) || column >= usize::from(sub.count)) {
                    return Err(CodeError::UnusedCode(row, column));
                }
            }
        }
        if any { Ok(Self { main, sub, speeds }) } else { Err(CodeError::NoSpeed) }
    }

    /// The codes of the main carrier.
    pub const fn main(&self) -> &CodeFrequencies {
        &self.main
    }

    /// The codes of the sub carrier.
    pub const fn sub(&self) -> &CodeFrequencies {
        &self.sub
    }

    /// The speed that two codes name; `None` if one is missing or the pair names nothing.
    pub const fn speed(&self, main: Option<Code>, sub: Option<Code>) -> Option<KmhTenths> {
        //= spec/code.md#code-2-the-pair
        //# A missing code and a pair of codes that is not in the table MUST name no speed.
        match (main, sub) {
            (Some(main), Some(sub)) => self.speeds[main.0 as usize][sub.0 as usize],
            _ => None,
        }
    }

    /// The speed that two measured frequencies name.
    pub fn heard(&self, main: Option<Millihertz>, sub: Option<Millihertz>) -> Option<KmhTenths> {
        let main = main.and_then(|frequency| self.main.identify(frequency));
        let sub = sub.and_then(|frequency| self.sub.identify(frequency));
        self.speed(main, sub)
    }

    /// Whether a single code taken for another one of its carrier never names a speed: no two entries share a code.
    pub fn detects_one_wrong_code(&self) -> bool {
        let mut columns = 0_u8;
        for of_main in &self.speeds {
            let mut row = 0_u8;
            for (column, speed) in of_main.iter().enumerate() {
                row |= u8::from(speed.is_some()) << column;
            }
            if row.count_ones() > 1 || row & columns != 0 {
                return false;
            }
            columns |= row;
        }
        true
    }
}
