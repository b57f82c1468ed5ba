//! Kani's entry points of a harness: attributes take literals only, and a macro cannot make names.

/// `kani_proofs!([unwind solver] [cases])`: one proof of all cases, or one proof for each case that is named.
macro_rules! kani_proofs {
    ($options:tt []) => {
        kani_proof!($options kani: $crate::engine::model::Kani::ANY);
    };
    ($options:tt [$($case:tt)+]) => {
        $(kani_case!($case $options);)+
    };
}

/// One proof.
macro_rules! kani_proof {
    ([$unwind:literal $($solver:ident)?] $name:ident: $engine:expr) => {
        #[kani::proof]
        #[kani::unwind($unwind)]
        $(#[kani::solver($solver)])?
        fn $name() {
            let mut engine = $engine;
            run(&mut engine);
        }
    };
}

/// The proof of one case.
macro_rules! kani_case {
    (@ $options:tt $name:ident $case:literal) => {
        kani_proof!($options $name: $crate::engine::model::Kani::case($case, HARNESS.apart));
    };
    (0 $options:tt) => { kani_case!(@ $options case_0 0); };
    (1 $options:tt) => { kani_case!(@ $options case_1 1); };
    (2 $options:tt) => { kani_case!(@ $options case_2 2); };
    (3 $options:tt) => { kani_case!(@ $options case_3 3); };
    (4 $options:tt) => { kani_case!(@ $options case_4 4); };
    (5 $options:tt) => { kani_case!(@ $options case_5 5); };
    (6 $options:tt) => { kani_case!(@ $options case_6 6); };
    (7 $options:tt) => { kani_case!(@ $options case_7 7); };
    (8 $options:tt) => { kani_case!(@ $options case_8 8); };
    (9 $options:tt) => { kani_case!(@ $options case_9 9); };
    (10 $options:tt) => { kani_case!(@ $options case_10 10); };
    (11 $options:tt) => { kani_case!(@ $options case_11 11); };
    (12 $options:tt) => { kani_case!(@ $options case_12 12); };
    (13 $options:tt) => { kani_case!(@ $options case_13 13); };
    (14 $options:tt) => { kani_case!(@ $options case_14 14); };
    (15 $options:tt) => { kani_case!(@ $options case_15 15); };
    (16 $options:tt) => { kani_case!(@ $options case_16 16); };
    (17 $options:tt) => { kani_case!(@ $options case_17 17); };
    (18 $options:tt) => { kani_case!(@ $options case_18 18); };
    (19 $options:tt) => { kani_case!(@ $options case_19 19); };
}
