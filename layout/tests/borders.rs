//! What two stations see of the line between them, held against each other: `layouts/passing-loop.toml` beside itself, the east of the one against
//! the west of the other.

use atc_layout::border::{Border, compare, not_compared};
use atc_layout::{At, Description, Errors, Rule};

const LOOP: &str = include_str!("../../layouts/passing-loop.toml");

/// A station that calls itself so, with lines added to both of its segments.
fn station(name: &str, west: &str, east: &str) -> Description {
    let text = LOOP.replace("name = \"Passing loop\"", &format!("name = \"{name}\""));
    let text = text.replace("name = \"West\"\n", &format!("name = \"West\"\n{west}\n"));
    let text = text.replace("name = \"East\"\n", &format!("name = \"East\"\n{east}\n"));
    Description::from_toml("station.toml", &text).expect("a layout")
}

fn held(one: &Description, other: &Description) -> Result<Vec<Border>, Errors> {
    let (model, other_model) = (one.model().expect("a model"), other.model().expect("a model"));
    compare((one, &model), (other, &other_model))
}

/// The same station with other names for the circuits and joints of its west, so that they are those of the east of its neighbour.
fn renamed(description: &Description, names: &[(&str, &str)]) -> Description {
    let mut text = description.to_toml();
    for (from, to) in names {
        text = text.replace(&format!("\"{from}\""), &format!("\"{to}\""));
    }
    Description::from_toml("station.toml", &text).expect("a layout")
}

/// The neighbour in the east: its west is our east.
fn neighbour(line: &str) -> Description {
    renamed(&station("Neighbour", line, ""), &[("E1", "E8"), ("E2", "E9"), ("j", "far")])
}

fn refused(one: &Description, other: &Description, says: &str) {
    let errors = held(one, other).expect_err("the views do not agree");
    let message = errors.to_string();
    assert!(errors.breaks(Rule::ViewsApart) && message.contains(says), "{says:?} is not in {message}");
    assert!(message.starts_with("station.toml"), "{message}");
}

/// The session of the unseen stretch: each station ends its view at a joint of its own, and between the two nobody sees anything.
#[test]
fn views_that_do_not_meet() {
    let line = "line = \"between\"";
    let (one, other) = (station("One", "", line), neighbour(line));
    refused(
        &one,
        &other,
        "the view of One ends at joint j, that of Neighbour at joint a: a train between them is seen by neither",
    );
    refused(&other, &one, "the view of Neighbour ends at joint a, that of One at joint j");
}

#[test]
fn views_that_meet_at_a_joint() {
    let line = "line = \"between\"";
    let (one, other) = (station("One", "", line), renamed(&neighbour(line), &[("a", "j")]));
    let found = held(&one, &other).expect("they meet");
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].line, "between");
    assert!(found[0].shared.is_empty());
    assert_eq!(
        found[0].to_string(),
        "line between: one sees E1, E2, the other W1, W2; both see: none; no stretch is seen by neither"
    );
}

#[test]
fn views_that_overlap() {
    let one = station("One", "", "line = \"between\"\nshared = [\"E2\"]");
    let two = neighbour("line = \"between\"\nshared = [\"W2\"]");
    refused(&one, &two, "One shares E2 with its neighbour, and Neighbour shares W2");
    let other = renamed(&two, &[("W2", "E2")]);
    assert_eq!(held(&one, &other).expect("they overlap")[0].shared, ["E2"]);
    assert_eq!(held(&other, &one).expect("either way round")[0].shared, ["E2"]);
    // One of them says so alone.
    let silent = renamed(&neighbour("line = \"between\""), &[("W2", "E2")]);
    refused(&one, &silent, "Neighbour shares none");
    // The same circuit has one length.
    let mut long = other.clone();
    let circuit = long.station.circuits.iter_mut().find(|circuit| circuit.name.value == "E2").expect("E2");
    circuit.length_m.value = 400;
    refused(&one, &long, "E2 is 300 m long here and 400 m in Neighbour");
}

/// A code means the same speed on both sides: a train has one table.
#[test]
fn codes_agree() {
    let one = station("One", "", "line = \"b\"");
    let mut other = renamed(&neighbour("line = \"b\""), &[("a", "j")]);
    assert!(held(&one, &other).is_ok());
    other.station.braking.speeds_kmh.value = vec![25, 45, 55, 65, 75, 90];
    refused(
        &one,
        &other,
        "the codes mean [0, 15, 25, 45, 55, 65, 75, 90] km/h in One and [0, 25, 45, 55, 65, 75, 90, 0]",
    );
}

/// Both call the way to the other one right: no telegram could be told from one for the other direction.
#[test]
fn left_and_right_agree() {
    let one = station("One", "", "line = \"between\"\nshared = [\"E2\"]");
    let same = renamed(&station("Two", "", "line = \"between\"\nshared = [\"E2\"]"), &[("E1", "E8")]);
    refused(&one, &same, "leads out to the same side in One and in Two");
}

#[test]
fn no_line_in_common_and_a_turn_time_that_is_too_short() {
    let one = station("One", "line = \"a\"", "line = \"b\"");
    let far = renamed(&neighbour("line = \"c\""), &[("a", "west")]);
    refused(&one, &far, "no line in common (One: a, b; Neighbour: c)");
    let other = renamed(&neighbour("line = \"b\""), &[("a", "j")]);
    assert!(held(&one, &other).is_ok());
    // With a strong brake the station's own trains have soon run out.
    let (mut quick, mut slow) = (one.clone(), other.clone());
    quick.station.times.telegram_age_ms.value = 100;
    quick.station.braking.deceleration_mm_s2.value = 4000;
    slow.station.times.telegram_age_ms.value = 8000;
    refused(&quick, &slow, "One turns the line after 7500 ms, and telegrams in Neighbour live for 8000 ms");
}

/// A slip in the name of a second line between two stations; the twelfth attack's file was accepted, and that line was not looked at.
#[test]
fn a_line_under_two_names() {
    let one = station("One", "line = \"north\"", "line = \"middle\"");
    let two = |east: &str, joint: &str| {
        let it = station("Two", "line = \"middle\"", east);
        renamed(&it, &[("E1", "E8"), ("E2", "E9"), ("j", "far"), ("a", "j"), ("far", joint)])
    };
    let right = held(&one, &two("line = \"south\"", "far")).expect("two lines to others");
    assert_eq!(right.len(), 1);
    let (model, other) = (one.model().expect("a model"), two("line = \"south\"", "far"));
    assert_eq!(
        not_compared((&one, &model), (&other, &other.model().expect("a model"))),
        [
            "line north of One: Two names no such line, and it is not compared",
            "line south of Two: One names no such line, and it is not compared"
        ]
    );
    // Both views end at one joint.
    refused(
        &one,
        &two("line = \"nort\"", "a"),
        "One has a line north, and Two a line nort: both views end at one joint",
    );
    // Both share a circuit.
    let sharing = station("One", "line = \"north\"\nshared = [\"W2\"]", "line = \"middle\"");
    let also = renamed(&two("line = \"nort\"\nshared = [\"E9\"]", "far"), &[("W1", "V1"), ("W2", "V2"), ("E9", "W2")]);
    refused(&sharing, &also, "One has a line north, and Two a line nort: both see W2");
}

/// The thirteenth attack: a tail may be two routes behind a nose that the neighbour speaks to, or on another line beyond a short station.
#[test]
fn tails_behind_an_advanced_starter_and_beyond_a_short_station() {
    let read = |text: &str| Description::from_toml("station.toml", text).expect("a layout");
    let (west, east) =
        (include_str!("../../line/examples/westham.toml"), include_str!("../../line/examples/eastham.toml"));
    let east = read(east);
    assert!(held(&read(west), &east).is_ok());
    let head = &west[..west.find("[[route]]").expect("routes")];
    let starter = head
        .replace("name = \"E1\"\nlength_m = 300\nleft = \"h\"\nright = \"i\"", "name = \"X1\"\nlength_m = 100\nleft = \"h\"\nright = \"x\"\n\n[[circuit]]\nname = \"X2\"\nlength_m = 50\nleft = \"x\"\nright = \"i\"")
        .replace("circuits = [\"E1\", \"E2\"]", "circuits = [\"E2\"]");
    let route = |name: &str, entry: &str, path: &str| {
        format!(
            "[[route]]\nname = \"{name}\"\nentry = \"{entry}\"\npath = [{path}]\nshort_overlap = \"advanced starter\"\n"
        )
    };
    let station = |slow: u16| {
        let routes = [route("2-X", "2T", "\"P2T\", \"X1\""), route("X-E", "X1", "\"X2\"")].concat();
        read(&format!("{starter}{routes}").replace("reverse_kmh = 45", &format!("reverse_kmh = {slow}")))
    };
    refused(
        &station(45),
        &east,
        "the neighbour lets one run at 75 km/h whose tail is still in route 2-X, which is for 45",
    );
    held(&station(75), &east).expect("as fast as the line");
    let values = &west[west.find("longest_train_m").expect("values")..west.find("[speed]").expect("speeds")];
    let post = |kmh: u16, metres: u16| {
        let circuit = |name: &str, length: u16, left: &str, right: &str| {
            format!(
                "[[circuit]]\nname = \"{name}\"\nlength_m = {length}\ngradient = -10\nleft = \"{left}\"\nright = \"{right}\"\n"
            )
        };
        let circuits =
            [circuit("W1", 900, "a", "b"), circuit("M", metres, "b", "i"), circuit("E2", 300, "i", "j")].concat();
        let ends = ["a", "j"].map(|joint| format!("[[end]]\njoint = \"{joint}\"\nkind = \"line\"\n")).concat();
        let lines = format!(
            "[[segment]]\nname = \"West\"\ncircuits = [\"W1\"]\nspeed_kmh = {kmh}\n[[segment]]\nname = \"East\"\nline = \"middle\"\nshared = [\"E2\"]\ncircuits = [\"E2\"]\n"
        );
        read(&format!(
            "name = \"Post\"\n{values}[speed]\nline_kmh = 75\n{circuits}{ends}{lines}{}",
            route("W-E", "W1", "\"M\"")
        ))
    };
    refused(
        &post(45, 100),
        &east,
        "the neighbour lets one run at 75 km/h whose tail is still in segment West, which is for 45",
    );
    held(&post(75, 100), &east).expect("as fast as the line");
    held(&post(45, 200), &east).expect("as long as a train");
}

/// The fourteenth attack: the circuit that a train has left is held by nobody, and a route over it the other way has the lower limit.
#[test]
fn a_tail_in_the_circuit_that_the_train_has_left() {
    let at = |name: &str, turned: bool, kmh: u16| {
        let circuit = |circuit: &str, length: u16, ends: [&str; 2]| {
            let [left, right] = if turned { [ends[1], ends[0]] } else { ends };
            format!("[[circuit]]\nname = \"{circuit}\"\nlength_m = {length}\nleft = \"{left}\"\nright = \"{right}\"\n")
        };
        let own = ["T", "X", "Y"].map(|circuit| format!("{name}{circuit}"));
        let joints = ["b", "1", "2"].map(|joint| format!("{name}{joint}"));
        let circuits = [
            circuit(&own[0], 250, [&joints[0], &joints[1]]),
            circuit(&own[1], 60, [&joints[1], &joints[2]]),
            circuit(&own[2], 60, [&joints[2], &format!("{name}s")]),
            circuit("S", 700, [&format!("{name}s"), if name == "A" { "Bs" } else { "As" }]),
        ];
        let ends = [(joints[0].clone(), "buffer"), (if name == "A" { "Bs" } else { "As" }.to_owned(), "line")]
            .map(|(joint, kind)| format!("[[end]]\njoint = \"{joint}\"\nkind = \"{kind}\"\n"));
        let route = |route: &str, entry: &str, path: &str, more: &str| {
            format!(
                "[[route]]\nname = \"{route}\"\nentry = \"{entry}\"\npath = [{path}]\nshort_overlap = \"x\"\n{more}"
            )
        };
        let [t, x, y] = &own;
        let routes = [
            route("out", t, &format!("\"{x}\", \"{y}\""), ""),
            route("in", "S", &format!("\"{y}\""), ""),
            route("platform", y, &format!("\"{x}\", \"{t}\""), &format!("speed_kmh = {kmh}\n")),
        ];
        let text = format!(
            "name = \"{name}\"\nlongest_train_m = 200\n[speed]\nline_kmh = 75\n{}{}[[segment]]\nname = \"L\"\nline = \"l\"\ncircuits = [\"S\"]\nshared = [\"S\"]\n{}",
            circuits.concat(),
            ends.concat(),
            routes.concat()
        );
        Description::from_toml("station.toml", &text).expect("a layout")
    };
    held(&at("A", false, 75), &at("B", true, 75)).expect("as fast as the line");
    refused(
        &at("A", false, 25),
        &at("B", true, 75),
        "the neighbour lets one run at 75 km/h whose tail is still in route platform, over the circuit that it has left, which is for 25",
    );
}

/// Approaches, releases and circuits are as long as the trains ask for that come in.
#[test]
fn trains_of_the_neighbour_are_longer_shorter_or_lost_for_longer() {
    let one = station("One", "", "line = \"b\"");
    let other = renamed(&neighbour("line = \"b\""), &[("a", "j")]);
    let changed = |change: fn(&mut atc_layout::form::Station)| {
        let mut it = other.clone();
        change(&mut it.station);
        it
    };
    let lost = changed(|it| (it.times.shunt_loss_ms.value, it.times.clear_ms.value) = (2000, 4000));
    refused(&one, &lost, "trains of Neighbour may be lost for 2000 ms, and One counts on 1000 ms");
    let long = changed(|it| it.longest_train_m = Some(At::derived(201)));
    refused(&one, &long, "trains of Neighbour are up to 201 m long, and One counts on 200 m");
    let mut short = one.clone();
    short.station.shortest_train_m = Some(At::derived(40));
    refused(
        &short,
        &other,
        "One counts on trains of at least 40 m, and Neighbour does not say how short its trains are",
    );
    let shorter = changed(|it| it.shortest_train_m = Some(At::derived(39)));
    refused(&short, &shorter, "and Neighbour has trains of 39 m");
    held(&short, &changed(|it| it.shortest_train_m = Some(At::derived(40)))).expect("as long");
}

/// The neighbour's trains may run on for longer, and be lost for longer, than the station's own.
#[test]
fn times_of_the_neighbours_trains() {
    let one = station("One", "", "line = \"b\"");
    let other = renamed(&neighbour("line = \"b\""), &[("a", "j")]);
    let mut weak = other.clone();
    weak.station.braking.deceleration_mm_s2.value = 400;
    for (one, other) in [(&one, &weak), (&weak, &one)] {
        refused(
            one,
            other,
            "One turns the line and confirms blocks on it after 34300 ms, and a train of Neighbour may run in for 65500 ms: telegrams live for \
             1000 ms, it runs on for 63500 ms, and may be lost for 1000 ms; turn_ms of One must be at least 65500",
        );
        refused(
            one,
            other,
            "after a start of One nothing moves for 60000 ms, and a train of Neighbour may run on for 64500 ms",
        );
    }
    let mut covered = one.clone();
    covered.station.times.turn_ms = Some(At::derived(65_500));
    covered.station.times.start_ms = Some(At::derived(65_500));
    refused(&covered, &weak, "trains of Neighbour brake with 400 mm/s², and One counts on 800 for distances");
    refused(&covered, &weak, "trains of Neighbour run on for 63500 ms, and One counts on 32250 ms for its routes");
    refused(
        &covered,
        &weak,
        "on its steepest fall One counts on 800 mm/s² of a train's brake, and Neighbour, whose trains come in, on 400",
    );
    // The other way round it is the code's distance here that is too short for a low code (a reader of T-ATC-8).
    refused(
        &weak,
        &covered,
        "on its steepest fall One counts on 800 mm/s² of a train's brake, and Neighbour, whose trains come in, on 400",
    );
    // A fall anywhere in a station is in its brake.
    let mut falls = one.clone();
    falls.station.circuits[0].gradient = Some(At::derived(-20));
    refused(&falls, &other, "on its steepest fall One counts on");
    // A brake as weak as theirs, and times to suit it.
    let mut alike = one.clone();
    alike.station.braking = weak.station.braking.clone();
    assert!(held(&alike, &weak).is_ok());
    let mut lossy = other.clone();
    (lossy.station.times.shunt_loss_ms.value, lossy.station.times.clear_ms.value) = (3000, 6000);
    lossy.station.shortest_train_m = Some(At::derived(3));
    for (one, other) in [(&one, &lossy), (&lossy, &one)] {
        refused(
            one,
            other,
            "in One a circuit counts as clear after 2000 ms, and a train of Neighbour may be lost for 3000 ms; clear_ms of One must be at \
             least 6000: twice that",
        );
    }
}

/// What the neighbour has granted stands until its next cycle, which may be longer than a cycle here: a train came in 0.5 m under a block that had been
/// confirmed (found in the eighth attack).
#[test]
fn a_neighbour_with_longer_cycles() {
    let one = station("One", "", "line = \"b\"");
    let other = renamed(&neighbour("line = \"b\""), &[("a", "j")]);
    let mut slow = other.clone();
    slow.station.times.cycle_ms.value = 500;
    let turned = |ms| {
        let mut one = one.clone();
        one.station.times.turn_ms = Some(At::derived(ms));
        held(&one, &slow)
    };
    assert!(turned(34_700).is_ok());
    let errors = turned(34_600).expect_err("too short").to_string();
    let says = "a train of Neighbour may run in for 34650 ms: telegrams live for 1000 ms, it runs on for 32250 ms, and may be lost for 1000 ms, a cycle \
                there is 400 ms longer; turn_ms of One must be at least 34650";
    assert!(errors.contains(says), "{errors}");
}

/// A train of the neighbour is lost in the circuits of this station for as long as these allow.
#[test]
fn a_loss_that_is_longer_here() {
    let mut one = station("One", "", "line = \"b\"");
    let mut other = renamed(&neighbour("line = \"b\""), &[("a", "j")]);
    (one.station.times.shunt_loss_ms.value, one.station.times.clear_ms.value) = (3000, 6000);
    one.station.shortest_train_m = Some(At::derived(3));
    other.station.times.clear_ms.value = 6000;
    // Its own trains run in sooner than the neighbour's.
    one.station.braking.deceleration_mm_s2.value = 800;
    one.station.times.telegram_age_ms.value = 500;
    one.station.times.turn_ms = Some(At::derived(35_800));
    refused(
        &one,
        &other,
        "may run in for 36250 ms: telegrams live for 1000 ms, it runs on for 32250 ms, and may be lost for 3000 ms",
    );
}

/// The neighbour's device does not know the points that a tail lies on, nor the speed over them.
#[test]
fn tails_that_the_neighbour_does_not_see() {
    let line = "line = \"b\"\nshared = [\"E2\"]";
    let (one, two) =
        (station("One", "", line), renamed(&neighbour("line = \"b\"\nshared = [\"W2\"]"), &[("W2", "E2")]));
    assert!(held(&one, &two).is_ok());
    let mut long = two.clone();
    long.station.longest_train_m = Some(At::derived(301));
    for (one, other) in [(&one, &long), (&long, &one)] {
        refused(
            one,
            other,
            "One alone sees 300 m of the line, and trains are up to 301 m long: the neighbour lets one run at 75 km/h whose tail is still in \
             route E-2, which is for 45; let One see 301 m or more of the line alone, or give the line a speed_kmh of 45 in both files",
        );
    }
    let mut unsaid = two.clone();
    unsaid.station.longest_train_m = None;
    refused(&one, &unsaid, "not both files say how long trains are");
    // All that one of them sees is shared: its points lie next to it.
    let all = station("One", "", "line = \"b\"\nshared = [\"E1\", \"E2\"]");
    let three = renamed(&neighbour("line = \"b\"\nshared = [\"W1\", \"W2\"]"), &[("W2", "E1"), ("W1", "E2")]);
    refused(&all, &three, "One alone sees 0 m of the line, and trains are up to 200 m long");
    refused(&all, &three, "Neighbour alone sees 0 m of the line");
    // A line that is no faster than the points.
    let slow = |station: &Description| {
        let mut slow = station.clone();
        let segments = slow.station.segments.iter_mut().filter(|segment| segment.line.is_some());
        segments.for_each(|segment| segment.speed_kmh = Some(At::derived(45)));
        slow
    };
    let mut both = one.clone();
    both.station.longest_train_m = Some(At::derived(301));
    assert!(held(&slow(&both), &slow(&long)).is_ok() && held(&slow(&all), &slow(&three)).is_ok());
}

/// A tail that still lies on this side of the border is not seen on the other: the line has one speed.
#[test]
fn one_speed_across_the_border() {
    let one = station("One", "", "line = \"b\"\nspeed_kmh = 45");
    refused(
        &one,
        &renamed(&neighbour("line = \"b\""), &[("a", "j")]),
        "trains run at 45 km/h here and at 75 in Neighbour",
    );
    let twice = station("One", "line = \"b\"", "line = \"b\"").compile().expect_err("one line, two neighbours");
    assert!(twice.breaks(Rule::NameTwice), "{twice}");
}

/// What is shared is what lies outermost.
#[test]
fn shared_within() {
    let error = station("One", "", "shared = [\"E1\"]").compile().expect_err("E1 is the inner one");
    assert!(error.breaks(Rule::SharedWithin), "{error}");
    let error = station("One", "", "shared = [\"E2\", \"E1\"]").compile().expect_err("not outward");
    assert!(error.breaks(Rule::SharedWithin), "{error}");
    let both = station("One", "", "shared = [\"E1\", \"E2\"]").compile().expect("a layout");
    assert_eq!(both.plan.segments[1].shared, 2);
}

/// A train that acts on its telegrams for 8 s is one on both sides of the border. The distances of the codes, and the approaches, of a station that counts
/// on 1 s are too short for it (found in the tenth attack).
#[test]
fn a_neighbour_whose_trains_act_on_telegrams_for_longer() {
    let mut one = station("One", "", "line = \"b\"");
    let mut other = renamed(&neighbour("line = \"b\""), &[("a", "j")]);
    other.station.times.telegram_age_ms.value = 8000;
    for station in [&mut one, &mut other] {
        station.station.times.residual_ms = Some(At::derived(40_000));
        station.station.times.turn_ms = Some(At::derived(55_000));
    }
    one.compile().expect("a layout that keeps every rule");
    for (first, second) in [(&one, &other), (&other, &one)] {
        refused(
            first,
            second,
            "trains of Neighbour act on telegrams and codes for 8000 ms, and One counts on 1000 ms for distances; telegram_age_ms of One must \
             be at least 8000",
        );
    }
    let age = |ms| {
        let mut one = one.clone();
        one.station.times.telegram_age_ms.value = ms;
        held(&one, &other)
    };
    assert!(age(7_999).is_err());
    assert!(age(8_000).is_ok());
    assert!(age(8_001).is_err(), "the neighbour counts on less than the trains that it gets from here");
}

/// What is from the antenna to the nose comes with the neighbour's train.
#[test]
fn a_neighbour_whose_trains_hear_codes_farther_beyond() {
    let one = station("One", "", "line = \"b\"");
    let mut other = renamed(&neighbour("line = \"b\""), &[("a", "j")]);
    other.station.braking.heard_beyond_m.value = 15;
    refused(
        &one,
        &other,
        "Neighbour counts on trains that hear codes 15 m beyond their circuits, and One counts on 0 m for distances; heard_beyond_m of One must \
         be at least 15",
    );
    let mut alike = one.clone();
    alike.station.braking.heard_beyond_m.value = 15;
    assert!(held(&alike, &other).is_ok());
}

/// A train that comes from the neighbour may have come from telegrams by a stronger pattern there.
#[test]
fn a_neighbour_whose_trains_come_from_telegrams_by_a_stronger_pattern() {
    let one = station("One", "", "line = \"b\"");
    let mut other = renamed(&neighbour("line = \"b\""), &[("a", "j")]);
    other.station.braking.strongest_mm_s2 = Some(At::derived(1_200));
    refused(
        &one,
        &other,
        "trains of Neighbour may come from telegrams with a pattern of 1200 mm/s², and One counts on at most 800 for the distances of codes; \
         strongest_mm_s2 of One must be at least 1200",
    );
    let mut alike = one.clone();
    alike.station.braking.strongest_mm_s2 = Some(At::derived(1_200));
    assert!(held(&alike, &other).is_ok());
}

/// The rear of a cab-signalled route begins at its entry: a driver who waits on the approach for the signal is not looked for.
#[test]
fn a_neighbour_whose_drivers_go_by_signals() {
    let mut one = station("One", "", "line = \"b\"");
    one.station.cab_signalled = true;
    let mut other = renamed(&neighbour("line = \"b\""), &[("a", "j")]);
    refused(
        &one,
        &other,
        "One counts on trains that act on telegrams alone, and trains of Neighbour, which come in, may go by signals; leave cab_signalled out in One",
    );
    assert!(held(&other, &one).is_err(), "in either order");
    other.station.cab_signalled = true;
    assert!(held(&one, &other).is_ok());
}

/// On a line for one direction the station that trains leave may count on less.
#[test]
fn an_age_on_a_line_for_one_direction() {
    let one_way = |description: &Description, side: &str, comes: bool| {
        let mut description = description.clone();
        let number = description.station.segments.iter().position(|segment| segment.name.value == side).expect(side);
        let model = description.model().expect("a model");
        let kept = model.routes.iter().map(|route| (if comes { route.to } else { route.from }) != Some(number));
        let mut kept = kept.collect::<Vec<_>>().into_iter();
        description.station.routes.retain(|_| kept.next() == Some(true));
        description
    };
    let one = one_way(&station("One", "", "line = \"b\""), "East", true);
    let mut other = one_way(&renamed(&neighbour("line = \"b\""), &[("a", "j")]), "West", false);
    let mut ages = |ms| {
        other.station.times.telegram_age_ms.value = ms;
        let mut both = [one.clone(), other.clone()];
        for station in &mut both {
            station.station.times.residual_ms = Some(At::derived(33_000));
            station.station.times.turn_ms = Some(At::derived(36_000));
        }
        held(&both[0], &both[1]).map_err(|errors| errors.to_string())
    };
    let found = ages(1_001).expect_err("trains come from a neighbour whose trains act for longer");
    assert!(found.contains("telegram_age_ms of One must be at least 1001"), "{found}");
    let found = ages(999);
    assert!(found.is_ok(), "no train goes there: {found:?}");
}
