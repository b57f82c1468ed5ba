//! The lines of the models of aspect acceptance.

use atc_models::line::{COARSE, DEFAULT, EARLY, FINE, LATE, Line, SHORTEST, credited_gap};

#[test]
fn every_line_is_accepted_and_is_what_it_says() {
    let credited = |line: Line| (credited_gap(line.ticks()), line.ticks().interruption().0);
    assert_eq!(DEFAULT.ticks().tolerated_interruption().0, 70);
    assert_eq!(COARSE.ticks().tolerated_interruption().0, 7);
    assert_eq!(credited(FINE), (14, 15));
    assert_eq!(credited(LATE), (3, 4));
    assert_eq!(credited(EARLY), (2, 2));
    assert_eq!(credited(SHORTEST), (0, 0));
}
