//! Analog codes: the bands to the millihertz, pairs, and every rule of the constructors.

use atc_kernel::code::{Code, CodeError, CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::speed::KmhTenths;
use proptest::prelude::*;

const MAIN: [u32; 6] = [10_000, 15_000, 22_000, 29_000, 36_000, 41_500];
const SUB: [u32; 6] = [12_000, 16_500, 21_000, 27_000, 32_000, 38_500];

fn frequencies(nominal: &[u32], tolerance: u32) -> Result<CodeFrequencies, CodeError> {
    let nominal: Vec<_> = nominal.iter().copied().map(Millihertz).collect();
    CodeFrequencies::new(&nominal, Millihertz(tolerance))
}

/// The default codes, the k-th main code with the k-th sub code.
fn diagonal() -> CodeTable {
    let mut speeds = [[None; MAX_CODES]; MAX_CODES];
    for (place, speed) in [150, 250, 450, 650, 750, 900].into_iter().enumerate() {
        speeds[place][place] = Some(KmhTenths(speed));
    }
    CodeTable::new(frequencies(&MAIN, 800).unwrap(), frequencies(&SUB, 800).unwrap(), speeds).unwrap()
}

/// Every millihertz up to 50 Hz: a code if and only if some frequency is within the tolerance, and then that one.
#[test]
fn the_bands_to_the_millihertz() {
    for (nominal, tolerance) in [(MAIN, 800), (SUB, 800), (MAIN, 0), (SUB, 2249)] {
        let codes = frequencies(&nominal, tolerance).unwrap();
        for measured in 0..50_000_u32 {
            let near = nominal.iter().position(|frequency| measured.abs_diff(*frequency) <= tolerance);
            let code = codes.identify(Millihertz(measured)).map(|code| usize::from(code.place()));
            assert_eq!(code, near, "{measured} mHz with ±{tolerance}");
        }
        assert_eq!(codes.identify(Millihertz(u32::MAX)), None);
    }
}

#[test]
fn pairs() {
    let table = diagonal();
    assert!(table.detects_one_wrong_code());
    for main in 0..8 {
        for sub in 0..8 {
            let expected = [150, 250, 450, 650, 750, 900].get(usize::from(main)).filter(|_| main == sub);
            assert_eq!(table.speed(Code::new(main), Code::new(sub)), expected.copied().map(KmhTenths));
            assert_eq!(table.speed(None, Code::new(sub)), None);
        }
        assert_eq!(table.speed(Code::new(main), None), None);
    }
    assert_eq!(Code::new(8), None);
    let heard = |main: u32, sub: u32| table.heard(Some(Millihertz(main)), Some(Millihertz(sub)));
    assert_eq!(heard(22_800, 20_200), Some(KmhTenths(450)));
    assert_eq!(heard(22_801, 20_200), None);
    assert_eq!(heard(22_000, 27_000), None);
    assert_eq!(table.heard(None, Some(Millihertz(21_000))), None);
    assert_eq!(table.heard(Some(Millihertz(22_000)), None), None);
}

/// Two speeds that share a code: a single wrong code could name the other one, and the table says so.
#[test]
fn a_table_that_one_wrong_code_can_cross() {
    for second in [(0, 1), (1, 0)] {
        let mut speeds = [[None; MAX_CODES]; MAX_CODES];
        speeds[0][0] = Some(KmhTenths(150));
        speeds[second.0][second.1] = Some(KmhTenths(250));
        let table = CodeTable::new(frequencies(&MAIN, 800).unwrap(), frequencies(&SUB, 800).unwrap(), speeds).unwrap();
        assert!(!table.detects_one_wrong_code(), "{second:?}");
    }
}

#[test]
fn every_rule_of_the_constructors() {
    assert_eq!(frequencies(&[], 0), Err(CodeError::NoFrequency));
    assert_eq!(frequencies(&[1, 2, 3, 4, 5, 6, 7, 8, 9], 0), Err(CodeError::TooManyFrequencies));
    assert!(frequencies(&[1, 2, 3, 4, 5, 6, 7, 8], 0).is_ok());
    assert_eq!(frequencies(&[800], 800), Err(CodeError::OutOfRange));
    assert!(frequencies(&[801], 800).is_ok());
    assert_eq!(frequencies(&[0], 0), Err(CodeError::OutOfRange));
    assert_eq!(frequencies(&[u32::MAX - 799], 800), Err(CodeError::OutOfRange));
    assert!(frequencies(&[u32::MAX - 800], 800).is_ok());
    assert_eq!(frequencies(&[10_000, 11_600], 800), Err(CodeError::BandsTouch(1)));
    assert!(frequencies(&[10_000, 11_601], 800).is_ok());
    assert_eq!(frequencies(&[10_000, 15_000, 15_000], 0), Err(CodeError::BandsTouch(2)));
    assert_eq!(frequencies(&[15_000, 10_000], 0), Err(CodeError::BandsTouch(1)));
    let codes = frequencies(&MAIN, 800).unwrap();
    let none = [[None; MAX_CODES]; MAX_CODES];
    assert_eq!(CodeTable::new(codes, codes, none), Err(CodeError::NoSpeed));
    for (main, sub) in [(6, 0), (0, 6), (7, 7)] {
        let mut speeds = none;
        speeds[main][sub] = Some(KmhTenths(150));
        assert_eq!(CodeTable::new(codes, codes, speeds), Err(CodeError::UnusedCode(main, sub)));
    }
}

proptest! {
    /// Any list: it is taken if and only if bands are above 0, below the top, and apart.
    #[test]
    fn any_list(nominal in prop::collection::vec(0..60_000_u32, 0..10), tolerance in 0..4000_u32) {
        let mut nominal = nominal;
        if tolerance % 4 > 0 {
            nominal.sort_unstable();
        }
        let wide: Vec<_> = nominal.iter().map(|one| i64::from(*one)).collect();
        let off = i64::from(tolerance);
        let apart = wide.windows(2).all(|pair| pair[0] + off < pair[1] - off);
        let sound = (1..=8).contains(&wide.len()) && wide[0] - off > 0 && apart;
        prop_assert_eq!(frequencies(&nominal, tolerance).is_ok(), sound);
    }
}
