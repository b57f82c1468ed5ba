//! The models of the permitted speed.

use crate::catalogue::about::about;
use crate::check::Entry;
use crate::permitted::device::Conventional;
use crate::permitted::layout::{Layout, Section};
use crate::permitted::ride::{Changes, Delivery, Environment, Fix, Odometer, Small, Told};
use crate::permitted::{Purpose, Sight};
use atc_kernel::permitted::LineKind;

mod border;
mod counter;
mod shared;

use shared::{AGE, DISTANCE, NO_ODOMETER, NO_POINT_LIFE, NO_WORST, NOT_TOLD, SOUND, WORST, other, ride};

/// Two kinds of line, losses, changes on the ground, borders, distances and counters.
pub(super) fn entries() -> Vec<Entry> {
    let mut entries = lines();
    entries.extend(changes());
    entries.extend(late());
    entries.extend(border::entries());
    entries.extend(distances());
    entries.extend(counter::entries());
    entries
}

fn lines() -> Vec<Entry> {
    let analog = |cells| Section::plain(LineKind::Analog, cells);
    let new = |cells| Section::plain(LineKind::Digital, cells);
    let mixed = Layout { sections: vec![analog(2), new(3), new(3), analog(3)], points: vec![9] };
    let ends = Layout { sections: vec![analog(2), new(3), new(3)], points: vec![5] };
    let any = Environment { sub: Delivery::Any, code: Delivery::Any, ..Environment::USUAL };
    let codes = Environment { main: Delivery::Never, sub: Delivery::Never, ..any };
    let lossy = Environment { sub: Delivery::Any, code: Delivery::Always, fix: Fix::Any, ..Environment::USUAL };
    vec![
        ride(
            about(
                "permitted-lines",
                "A new train comes from an analog line over a digital one to an analog one, whatever codes and telegrams are lost: \
                 never above the code, and on the digital line never above what the ground allows.",
                "codes, main and sub telegrams are lost in any cycle; a code may be misread on one carrier",
                &["PER-1", "PER-2", "PER-3", "PER-6", "CODE-1", "CODE-2"],
                SOUND,
            ),
            &mixed,
            Small::USUAL,
            any,
            Purpose::Safe(&[Sight::Pattern, Sight::RunsDown, Sight::Starved, Sight::Recovers, Sight::Crosses]),
        ),
        ride(
            about(
                "permitted-lines-not-told",
                "A train that is not told that the digital line has begun takes missing telegrams for normal: on its code it is permitted \
                 more than the ground allows.",
                "the same; the train may be told late or never that the digital line begins",
                &["PER-2", "PER-6"],
                NOT_TOLD,
            ),
            &ends,
            Small::USUAL,
            Environment { told: Told::PerhapsNotOfDigital, ..any },
            Purpose::Hazard(&["line-is-told"]),
        ),
        other(
            about(
                "permitted-lines-conventional",
                "A conventional train on the same lines runs on the codes alone: what the code table names, and nothing else.",
                "codes are lost in any cycle, or misread on one carrier",
                &["CODE-1", "CODE-2"],
                SOUND,
            ),
            Conventional,
            &mixed,
            Small::USUAL,
            codes,
            Purpose::Safe(&[Sight::Conventional]),
        ),
        ride(
            about(
                "permitted-loss",
                "The digital part is lost in any cycles, and for good from any cycle on: the last pattern runs down, and the train \
                 stands 3 cycles after the life of the last telegram; it never passes the stopping point.",
                "main and sub telegrams are lost in any cycle; the distance to the exit is measured in any cycle",
                &["PER-1", "PER-4", "PER-6", "PER-8"],
                SOUND,
            ),
            &Layout::digital(&[3, 4, 2], &[7]),
            Small { margin: 2, ..Small::USUAL },
            lossy,
            Purpose::Safe(&[Sight::Pattern, Sight::RunsDown, Sight::Starved, Sight::Recovers, Sight::Arrives]),
        ),
    ]
}

fn changes() -> Vec<Entry> {
    let drawn = Layout::digital(&[2, 3, 3], &[5, 5, 7]);
    let environment = Environment { route: Changes::Any, fix: Fix::Any, ..Environment::USUAL };
    let mut restricted = Layout::digital(&[8, 4], &[12]);
    restricted.sections[0].restrictable = true;
    let restriction =
        Environment { main: Delivery::Always, sub: Delivery::Any, restriction: true, ..Environment::USUAL };
    let short = |keeps| Environment { keeps, ..environment };
    let short_limit = |keeps_limit| Environment { keeps_limit, ..restriction };
    let life = Small::USUAL;
    vec![
        ride(
            about(
                "permitted-withdrawn",
                "The stopping point is drawn back and advanced in any cycle while main telegrams are lost: never above what the \
                 ground has allowed within the life of a telegram, and this age is reached.",
                "main telegrams are lost in any cycle; two stopping points, the nearer one with two speeds, in any order; distances in any cycle",
                AGE,
                SOUND,
            ),
            &drawn,
            Small::USUAL,
            Environment { code: Delivery::Always, ..environment },
            Purpose::Safe(&[Sight::Pattern, Sight::OldPoint]),
        ),
        ride(
            about(
                "permitted-withdrawn-at-once",
                "A ground that keeps a withdrawn stretch free for a cycle less than the life of a telegram: more is permitted than it \
                 allows.",
                "the same; the withdrawn stretch is kept for the life less 1 cycle",
                AGE,
                NO_POINT_LIFE,
            ),
            &drawn,
            Small::USUAL,
            Environment { code: Delivery::Always, ..short(life.life - 1) },
            Purpose::Hazard(&["stop-point-life"]),
        ),
        ride(
            about(
                "permitted-restriction",
                "A restriction is imposed under way, and sub telegrams are lost: the old limit is used for the life of a sub telegram at \
                 most, and this age is reached.",
                "the restriction comes in any cycle; sub telegrams are lost in any cycle",
                WORST,
                SOUND,
            ),
            &restricted,
            Small::USUAL,
            restriction,
            Purpose::Safe(&[Sight::Pattern, Sight::Restricted, Sight::OldLimit]),
        ),
        ride(
            about(
                "permitted-restriction-at-once",
                "A ground that relies on a restriction a cycle before the life of a sub telegram is over: more is permitted than it \
                 allows.",
                "the same; the restriction is relied on after the life of a sub telegram less 1 cycle",
                WORST,
                NO_POINT_LIFE,
            ),
            &restricted,
            Small::USUAL,
            short_limit(life.fixed_life - 1),
            Purpose::Hazard(&["stop-point-life"]),
        ),
    ]
}

fn late() -> Vec<Entry> {
    let mut downhill = Layout::digital(&[3, 4, 3], &[7]);
    downhill.sections[1].gradient = -100;
    let steep = |worst| Small { lowest: 1, worst, ..Small::USUAL };
    let environment = Environment { sub: Delivery::Any, fix: Fix::Any, ..Environment::USUAL };
    let mut slow = Layout::digital(&[3, 6, 2], &[11]);
    slow.sections[1].limit = 0;
    slow.sections[1].limit_from = 3;
    let brief = |lowest| Small { lowest, fresh: 2, life: 2, memory: 2, ..Small::USUAL };
    let model = |name, statement: &str, layout: &Layout, small, conditions, purpose| {
        let words = "main and sub telegrams are lost in any cycle, or never come; distances in any cycle";
        ride(about(name, statement, words, WORST, conditions), layout, small, environment, purpose)
    };
    let safe = Purpose::Safe(&[Sight::Pattern]);
    let hazard = Purpose::Hazard(&["sub-data-worst"]);
    vec![
        model(
            "permitted-sub-late-gradient",
            "A section falls by 100 thousandths, and its sub telegram comes late or never: until it is there the worst gradient counts.",
            &downhill,
            steep(-100),
            SOUND,
            safe,
        ),
        model(
            "permitted-sub-late-gradient-not-worst",
            "The worst gradient that the train assumes is less than that of a section: before its sub telegram is there more is \
             permitted than the ground allows.",
            &downhill,
            steep(-20),
            NO_WORST,
            hazard,
        ),
        model(
            "permitted-sub-late-limit",
            "A section has a limit, and its sub telegram comes late or never: until it is there the lowest limit counts.",
            &slow,
            brief(0),
            SOUND,
            safe,
        ),
        model(
            "permitted-sub-late-limit-not-lowest",
            "The lowest limit that the train assumes is higher than that of a section: before its sub telegram is there more is \
             permitted than the ground allows.",
            &slow,
            brief(1),
            NO_WORST,
            hazard,
        ),
    ]
}

fn distances() -> Vec<Entry> {
    let layout = Layout::digital(&[6, 3], &[7]);
    let with = |odometer| Environment { odometer, fix: Fix::Any, ..Environment::USUAL };
    let model = |name, statement: &str, words: &str, environment, conditions, purpose| {
        ride(about(name, statement, words, DISTANCE, conditions), &layout, Small::USUAL, environment, purpose)
    };
    let sights = Purpose::Safe(&[Sight::Pattern]);
    vec![
        model(
            "permitted-odometer",
            "The odometer says up to a cell too much in any cycle: never above what the ground allows.",
            "main telegrams are lost, and distances are measured, in any cycle; the odometer slips within its bound",
            with(Odometer::Bounded),
            SOUND,
            sights,
        ),
        model(
            "permitted-odometer-short",
            "The odometer says less than the train has moved: more is permitted than the ground allows.",
            "main telegrams are lost, and distances are measured, in any cycle; the odometer may say a cell too little",
            with(Odometer::Short),
            NO_ODOMETER,
            Purpose::Hazard(&["odometer-bound"]),
        ),
        model(
            "permitted-position",
            "The distance to the exit is the near end of the interval of the kernel's position device, in wet and dry and with every \
             error of the levels within the tolerance: never above what the ground allows.",
            "main telegrams and levels are lost in any cycle; the transmitter of the position signals is at the exit",
            Environment { fix: Fix::Levels, ..Environment::USUAL },
            SOUND,
            sights,
        ),
    ]
}
