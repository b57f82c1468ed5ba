//! No construct that Kani or Creusot cannot take stands in the crates that they verify: those that are `no_std`.

mod finder;

use finder::found;
use std::path::{Path, PathBuf};

fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|end| end == "rs") {
            into.push(path);
        }
    }
}

/// The sources of the crates that are verified.
fn verified() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let mut crates = Vec::new();
    for entry in std::fs::read_dir(root).unwrap() {
        let folder = entry.unwrap().path().join("src");
        let library = std::fs::read_to_string(folder.join("lib.rs")).unwrap_or_default();
        if library.lines().any(|line| line == "#![no_std]") {
            crates.push(folder);
        }
    }
    for name in ["kernel", "proofs"] {
        assert!(crates.contains(&root.join(name).join("src")), "{name} is not among {crates:?}");
    }
    let mut files = Vec::new();
    for folder in &crates {
        sources(folder, &mut files);
    }
    files
}

#[test]
fn the_crates_that_are_verified_have_nothing_that_kani_or_creusot_cannot_take() {
    let files = verified();
    let texts: Vec<_> = files.iter().map(|file| std::fs::read_to_string(file).unwrap()).collect();
    assert!(texts.iter().any(|text| text.contains("harness! {")));
    let mut all = Vec::new();
    for (file, faults) in files.iter().zip(found(&texts)) {
        all.extend(faults.iter().map(|fault| format!("{}: {fault}", file.display())));
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
}

/// Kani asserts what a contract requires wherever the function is called: only a function that is not total may require something.
#[test]
fn a_contract_for_kani_requires_nothing_but_a_divisor() {
    let mut contracts = 0;
    for file in verified() {
        let text = std::fs::read_to_string(&file).unwrap();
        contracts += text.matches("kani::ensures(").count();
        let required = text.split("kani::requires(").skip(1).map(|rest| rest.split(')').next().unwrap());
        required.for_each(|required| assert_eq!(required, "divisor > 0", "{}", file.display()));
    }
    assert!(contracts > 10, "only {contracts}");
}

/// How much is found in one text.
fn count(text: &str) -> usize {
    found(&[text.to_owned()])[0].len()
}

#[test]
fn sub_array_patterns_are_found_wherever_a_pattern_can_stand() {
    for pattern in
        ["[first, ..]", "[.., last]", "[first, .., last]", "[first, rest @ ..]", "[rest @ .., last]", "[rest @ ..]"]
    {
        for text in [
            format!("fn f(x: [u8; 4]) {{ let {pattern} = x; }}"),
            format!("fn f({pattern}: [u8; 4]) {{}}"),
            format!("fn f(x: [u8; 4]) -> u8 {{ match x {{ {pattern} => 0 }} }}"),
            format!("fn f(x: &[u8]) {{ if let {pattern} = x {{}} }}"),
            format!("fn f(x: Option<[u8; 4]>) {{ let Some({pattern}) = x else {{ return }}; }}"),
            format!("fn f(x: [u8; 4]) {{ let _ = |{pattern}: [u8; 4]| 0; }}"),
            format!("fn f(x: [[u8; 4]; 1]) {{ for {pattern} in x {{}} }}"),
            format!("harness! {{ name(e) {{ let {pattern} = e.word().to_le_bytes(); }} }}"),
            format!("macro_rules! m {{ ($x:expr) => {{ let {pattern} = $x; }} }}"),
        ] {
            assert_eq!(count(&text), 1, "{text}");
        }
    }
    let (first, second) =
        ("fn f(x: [u8; 2]) { let [a, b] = x; }", "fn f(x: &[u8]) { let _ = (&x[..], &x[1..], [0..2, 3..4]); }");
    let (third, fourth) =
        ("fn f(x: S) { let S { a, .. } = x; let (b, ..) = x.t; }", "fn f(x: &[u8]) { let [..] = x; }");
    for text in [first, second, third, fourth] {
        assert_eq!(count(text), 0, "{text}");
    }
}

#[test]
fn a_constant_index_into_an_array_of_generic_length_is_found() {
    for body in [
        "x[0]",
        "x[(1)]",
        "x[1 - 1]",
        "x[FIRST]",
        "x[super::FIRST]",
        "{ let first = 0; x[first] }",
        "{ let _ = || x[0]; 0 }",
        "{ let copy = x; copy[0] }",
        "{ let made = [0; N]; made[0] }",
        "{ let one = &x; one[0] }",
        "assert_at!({ x[0] })",
    ] {
        let text = format!("fn f<const N: usize>(x: [u8; N]) -> u8 {{ {body} }}");
        assert_eq!(count(&text), 1, "{text}");
    }
    for text in [
        "struct S<const N: usize> { a: [u8; N] } impl<const N: usize> S<N> { fn f(&self) -> u8 { self.a[0] } }",
        "struct S<const N: usize> { a: [u8; N] } impl<const N: usize> S<N> { fn f(&mut self) { self.a[0] = 1; } }",
        "struct S<const N: usize> { a: [u8; N] } fn f<const N: usize>(s: &S<N>) -> u8 { s.a[0] }",
        "impl<const N: usize> Line<N> { fn new(blocks: [Block; N]) { if blocks[0].hold() == 1 {} } }",
        "impl S { fn f<const N: usize>(x: &[u8; N]) -> u8 { x[0] } }",
        "trait T<const N: usize> { fn f(x: [u8; N + 1]) -> u8 { x[0] } }",
        "fn outer<const N: usize>() { fn f(_: [u8; 2]) {} let y: [u8; N] = g(); y[0]; }",
    ] {
        assert_eq!(count(text), 1, "{text}");
    }
    // A field that is declared in another file.
    let texts = ["struct S<const N: usize> { a: [u8; N] }", "fn f<const N: usize>(s: &S<N>) -> u8 { s.a[0] }"];
    assert_eq!(found(&texts.map(ToOwned::to_owned))[1].len(), 1);
}

#[test]
fn an_index_that_is_no_constant_or_an_array_of_fixed_length_is_not() {
    for text in [
        "fn f<const N: usize>(x: [u8; N]) -> Option<&u8> { x.first() }",
        "fn f<const N: usize>(x: [u8; N]) { for i in 0..N { x[i]; x[i + 1]; } }",
        "fn f<const N: usize>(x: [u8; N]) { let mut i = 0; while i < N { x[i]; i += 1; } }",
        "fn f<const N: usize>(x: [u8; 4]) -> u8 { x[0] }",
        "fn f<const N: usize>(x: &[u8; SIZE]) -> u8 { x[3] }",
        "fn f<const N: usize>(x: u16) -> u8 { x.to_le_bytes()[0] }",
        "fn f<const N: usize>(x: u16) -> u8 { let bytes = x.to_le_bytes(); bytes[0] }",
        "fn f<const N: usize>(x: [u8; N]) -> &[u8] { &x[1..] }",
        "fn f<const RANK: usize>(one: Parts<1>) -> u8 { one.run[0] }",
        "fn f(x: [u8; 4]) -> u8 { x[0] }",
        "struct S { a: [u8; 4] } fn f<const N: usize>(s: &S) -> u8 { s.a[0] }",
        "struct S<const N: usize> { a: [u8; N] } fn f(s: &S<3>) -> u8 { s.a[0] }",
        "harness! { name(e) { let x = [0; 4]; x[0]; } }",
    ] {
        assert_eq!(count(text), 0, "{text}");
    }
}

#[test]
fn weak_points_of_kani_are_found() {
    assert_eq!(count("#[kani::stub_verified(root)] fn f() {}"), 1);
    assert_eq!(count("#[cfg_attr(kani, kani::stub_verified(root))] fn f() {}"), 1);
    assert_eq!(count("fn f() { assert!(kani::forall!(|i in (0, 4)| a[i] == 0)); }"), 1);
    assert_eq!(count("harness! { n(e) { kani::exists!(|i in (0, 4)| a[i] == 0); } }"), 1);
    assert_eq!(count("#[cfg_attr(creusot, ensures(forall<i> 0 <= i ==> !members@[i]))] fn f() { kani::any() }"), 0);
}

#[test]
fn an_import_of_all_of_creusot_std_is_found() {
    assert_eq!(count("#[cfg(creusot)] use creusot_std::prelude::*;"), 1);
    assert_eq!(count("use creusot_std::*;"), 1);
    assert_eq!(count("use creusot_std::prelude::{View, ensures, requires};"), 0);
    assert_eq!(count("use super::*;"), 0);
}
