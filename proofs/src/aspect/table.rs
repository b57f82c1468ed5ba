//! TIME-4: the aspect table.

use atc_kernel::aspect::{AspectId, AspectTable, MAX_ASPECTS, TableError};
use atc_kernel::speed::KmhTenths;

/// One entry more than a table may have.
const ENTRIES: usize = MAX_ASPECTS + 1;

harness! {
    /// The constructor of the aspect table accepts exactly the tables of 1 to 16 strictly rising speeds, and keeps
    /// them: the aspect of rank i permits speed i, and no other speed names it.
    time_table(e)
    theorem "T-ACC-8";
    requirements ["TIME-4"];
    assumptions [];
    bound "";
    cases ENTRIES + 1;
    unwind 35 = 1 + 2 * ENTRIES;
    claims {
        Exact: "accepted if and only if there are 1 to 16 speeds and each is above the one before it",
        Kept: "an accepted table has the speeds that were given",
        Told: "the error names a rule that is broken, and the first place where it is",
    }
    covers {
        Accepted: "a table is accepted",
        Full: "a table of 16 is accepted",
        Refused: "a table is refused",
    }
    {
        let count = e.choose("entries", ENTRIES + 1);
        let mut speeds = [KmhTenths(0); ENTRIES];
        for place in 0..ENTRIES {
            let least = if place == 0 { 0 } else { speeds[place - 1].0.saturating_add(1) };
            speeds[place] = KmhTenths(e.word("speeds (0.1 km/h)", least..=least.saturating_add(3)));
        }
        let result = AspectTable::new(&speeds[..count]);
        let mut first_fault = ENTRIES;
        for place in (1..ENTRIES).rev() {
            if place < count && speeds[place] <= speeds[place - 1] {
                first_fault = place;
            }
        }
        let fits = 0 < count && count <= MAX_ASPECTS;
        e.claim(Claim::Exact as u32, result.is_ok() == (fits && first_fault == ENTRIES));
        let (mut kept, mut told) = (true, true);
        match &result {
            Ok(table) => {
                kept = table.speeds().len() == count;
                for place in 0..MAX_ASPECTS {
                    kept &= place >= count || table.speeds().get(place) == speeds.get(place);
                }
            }
            Err(TableError::Empty) => told = count == 0,
            Err(TableError::TooMany) => told = count > MAX_ASPECTS,
            Err(TableError::NotRising(place)) => told = *place == first_fault,
        }
        e.claim(Claim::Kept as u32, kept);
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, result.is_ok());
        e.cover(Cover::Full as u32, result.is_ok() && count == MAX_ASPECTS);
        e.cover(Cover::Refused as u32, result.is_err());
    }
}

harness! {
    /// In an accepted table the aspect of rank i permits speed i and is what that speed names; a speed that is not in
    /// the table names no aspect, and a rank that is not, no speed.
    table_names(e)
    theorem "T-ACC-8";
    requirements ["TIME-4"];
    assumptions [];
    bound "tables of 4 speeds";
    cases 1;
    unwind 35 = 1 + 2 * ENTRIES;
    claims {
        Speed: "a rank of the table has its speed, any other rank none",
        Aspect: "a speed of the table names its rank, any other speed none",
    }
    covers {
        Named: "a speed names the last rank of the table",
        Unknown: "a speed names no aspect",
    }
    {
        let speeds = [0..=3, 4..=7, 8..=11, 12..=15].map(|likely| e.word("speeds (0.1 km/h), rising", likely));
        e.assume(speeds[0] < speeds[1] && speeds[1] < speeds[2] && speeds[2] < speeds[3]);
        let Ok(table) = AspectTable::new(&speeds.map(KmhTenths)) else { return e.assume(false) };
        let asked = e.word("speed looked up (0.1 km/h)", 0..=16);
        let rank = e.word("rank looked up", 0..=15) & 15;
        let found = table.aspect(KmhTenths(asked)).map_or(16, |aspect| usize::from(aspect.rank()));
        let speed = AspectId::new(rank.to_le_bytes()[0]).and_then(|aspect| table.speed(aspect));
        let (mut expected_rank, mut expected_speed) = (16, None);
        for (place, speed) in speeds.into_iter().enumerate() {
            expected_rank = if speed == asked { place } else { expected_rank };
            expected_speed = if usize::from(rank) == place { Some(speed) } else { expected_speed };
        }
        e.claim(Claim::Speed as u32, speed.map(|speed| speed.0) == expected_speed);
        e.claim(Claim::Aspect as u32, found == expected_rank);
        e.cover(Cover::Named as u32, found == 3);
        e.cover(Cover::Unknown as u32, found == 16);
    }
}
