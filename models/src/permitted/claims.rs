//! What is claimed of a ride, what is counted for it, and its parameters in words.

use super::device::Device;
use super::layout::SPEEDS;
use super::purpose::{Purpose, Sight};
use super::ride::{Cycle, Ghosts, Ride, Shown, State, Told, Train, Transmitter};
use crate::subject::Claim;
use atc_kernel::permitted::{Basis, LineKind};
use atc_kernel::telegram::Main;

impl<D: Device> Ride<D> {
    /// More than this is not counted.
    pub(super) fn most_silent(&self) -> u16 {
        self.small.life.max(u16::from(self.small.window)) + 4
    }

    /// The ghosts after a cycle.
    pub(super) fn seen(&self, state: &State, cycle: &Cycle, train: &Train, shown: Shown) -> Ghosts {
        let before = &state.ghosts;
        let digital = self.kind_at(train.place) == LineKind::Digital;
        let from_analog = self.kind_at(state.train.place) == LineKind::Analog;
        // On an analog line nothing is sent: there the count stops where telegrams are lost. It does not begin again at the border.
        let silent = match cycle.heard.main {
            Some(_) => 0,
            None if digital && !from_analog => before.silent + 1,
            None => (before.silent + 1).min(self.small.life + 1),
        };
        let section = self.layout.section_at(train.place);
        let here = |id: u16| usize::from(id) == section;
        let same = section == self.layout.section_at(state.train.place);
        let in_a_row = match cycle.heard.main {
            Some(main) if here(main.section.0) => {
                if same {
                    before.in_a_row + 1
                } else {
                    1
                }
            }
            _ => 0,
        };
        let in_a_row = in_a_row.min(self.small.run + 1);
        let informed = digital && (before.informed || in_a_row > self.small.run || silent > self.small.life);
        let starving = digital && shown.speed == Some(0) && shown.basis == Basis::Nothing && train.moved == 0;
        let crossed = match (before.crossed, digital) {
            (0, true) if from_analog => 1,
            (1, false) => 2,
            (known, _) => known,
        };
        Ghosts {
            silent: silent.min(self.most_silent()),
            in_a_row,
            informed,
            starved: before.starved || starving && before.in_a_row > 0 || starving && state.train.place > 0,
            crossed,
            current: match cycle.heard.main {
                Some(main) => here(main.section.0) && !self.is_late(cycle, main),
                None => before.current && same && !cycle.counted,
            },
        }
    }

    /// Whether it is the telegram before the one with which the transmitter has frozen.
    fn is_late(&self, cycle: &Cycle, main: Main) -> bool {
        let frozen = self.environment.transmitter == Transmitter::FreezesAndLate && cycle.ground.repeats > 0;
        frozen && main.counter.0 != 0
    }

    /// Whether more is permitted than the ground allows, by telegrams.
    pub fn above_ground(&self, state: &State) -> bool {
        let Some(speed) = state.shown.speed.filter(|speed| *speed > 0) else { return false };
        let place = state.train.place;
        if !state.ghosts.informed || self.kind_at(place) == LineKind::Analog {
            return false;
        }
        let points = 0_u8..u8::try_from(self.layout.points.len()).unwrap_or(0);
        let mut kept = points.filter(|point| state.ground.point_age[usize::from(*point)] <= self.environment.keeps);
        let restricted = self.layout.sections[self.layout.section_at(place)].restrictable
            && state.ground.free_age > self.environment.keeps_limit;
        let limit = if restricted { SPEEDS[0] } else { self.layout.limit_at(place) };
        !kept.any(|point| self.layout.keeps(speed, place, point)) || speed > limit
    }

    pub(super) fn purpose_claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![
            Claim::<Self>::always("valid", "the device's state keeps its invariant", |m, s| {
                s.kept.0.is_valid(m.permitted())
            }),
            Claim::<Self>::always(
                "not-above-code",
                "where a code is heard no more than its speed is permitted, and on an analog line nothing without one",
                |m, s| {
                    let code = SPEEDS[usize::from(m.layout.sections[m.layout.section_at(s.train.place)].code)];
                    let analog = s.train.told == Some(LineKind::Analog);
                    s.shown.speed.is_none_or(|speed| if s.shown.code { speed <= code } else { !analog })
                },
            ),
        ];
        if D::DIGITAL && self.environment.told == Told::AtBorder {
            claims.extend(Self::without_telegrams());
        }
        if !D::DIGITAL {
            claims.push(Claim::<Self>::always(
                "the-code",
                "what the code names is permitted, and nothing else",
                |m, s| {
                    let code = SPEEDS[usize::from(m.layout.sections[m.layout.section_at(s.train.place)].code)];
                    s.shown.speed == s.shown.code.then_some(code)
                },
            ));
        }
        let text = "more is permitted than the ground has allowed for as long as it keeps what it withdraws";
        match self.purpose {
            Purpose::Safe(sights) => {
                if D::DIGITAL {
                    claims.push(Claim::<Self>::always(
                        "not-above-ground",
                        "on a digital line no more is permitted than what the ground has allowed, for as long as it keeps what \
                         it withdraws, at the true place, on the true gradients and limits",
                        |m, s| !m.above_ground(s),
                    ));
                }
                if D::DIGITAL && self.stops_short() {
                    claims.push(Claim::<Self>::always(
                        "stops-short",
                        "the train does not pass the stopping point",
                        |m, s| s.train.place <= m.layout.points[usize::from(s.ground.point)],
                    ));
                }
                claims.extend(sights.iter().map(|sight| Self::sight(*sight)));
            }
            Purpose::Hazard(excluded_by) => {
                claims.push(Claim::<Self>::hazard("above-ground", text, excluded_by, |m, s| m.above_ground(s)));
            }
        }
        claims
    }

    /// Whether a telegram that is repeated has just been used, as many cycles after the one before, or more.
    fn uses_repeated(&self, state: &State, cycles: u16) -> bool {
        let kernel = &state.kept.0;
        let just_used = kernel.main_stream.age.0 == 0 && kernel.main_stream.in_order > self.small.run;
        just_used && state.ground.repeats > 0 && kernel.target.is_some_and(|target| target.age.0 >= cycles)
    }

    /// Whether the train must come to a stand before the point: the margin covers what it moves in a cycle, the point stays
    /// where it is, and the line is digital from the start.
    fn stops_short(&self) -> bool {
        self.small.margin >= 2 && self.layout.points.len() == 1 && self.kind_at(0) == LineKind::Digital
    }

    fn without_telegrams() -> Vec<Claim<Self>> {
        vec![
            Claim::<Self>::always(
                "silence-stops",
                "on a digital line nothing above 0 is permitted once telegrams have been missing for longer than their life, \
                 and without a code nothing at all once they are not fresh",
                |m, s| {
                    let digital = m.kind_at(s.train.place) == LineKind::Digital;
                    let silent = |longest: u16| s.ghosts.silent > longest;
                    !digital
                        || (!silent(m.small.life) || s.shown.speed.is_none_or(|speed| speed == 0))
                            && (s.shown.code || !silent(m.small.fresh) || s.shown.speed.is_none())
                },
            ),
            Claim::<Self>::always(
                "stands-in-time",
                "on a digital line the train stands 3 cycles after the life of the last telegram",
                |m, s| {
                    let digital = m.kind_at(s.train.place) == LineKind::Digital;
                    !digital || s.ghosts.silent <= m.small.life + 2 || s.train.moved == 0
                },
            ),
        ]
    }

    fn sight(sight: Sight) -> Claim<Self> {
        let (name, text, condition): (_, _, fn(&crate::subject::Checked<Self>, &State) -> bool) = match sight {
            Sight::Pattern => ("on-the-pattern", "the train runs on the pattern, above the lowest limit", |_, s| {
                matches!(s.shown.basis, Basis::Pattern | Basis::Both)
                    && s.shown.speed > Some(SPEEDS[0])
                    && s.train.moved == 2
            }),
            Sight::RunsDown => ("runs-down", "telegrams are missing, and the last pattern runs down", |_, s| {
                let target = s.kept.0.target.is_some();
                s.shown.basis == Basis::RunningDown && target && s.shown.speed > Some(0) && s.train.moved > 0
            }),
            Sight::Starved => {
                ("starved", "telegrams are missing for too long, and the train stands", |_, s| s.ghosts.starved)
            }
            Sight::Recovers => ("recovers", "after that it runs on the pattern again", |_, s| {
                let again = matches!(s.shown.basis, Basis::Pattern | Basis::Both);
                s.ghosts.starved && again && s.train.moved > 0
            }),
            Sight::Crosses => {
                ("crosses-both-ways", "it comes from an analog line over a digital one to an analog one", |_, s| {
                    s.ghosts.crossed == 2 && s.shown.basis == Basis::Analog && s.train.moved > 0
                })
            }
            Sight::Restricted => ("restricted", "it runs at the restriction as its telegram says", |m, s| {
                let here = m.layout.section_at(s.train.place);
                let known =
                    s.kept.0.fixed.iter().flatten().any(|f| usize::from(f.section.0) == here && f.limit.0 == SPEEDS[0]);
                s.ground.restricted && m.layout.sections[here].restrictable && known && s.train.moved > 0
            }),
            Sight::OldPoint => {
                ("old-point", "a point is used as long after its withdrawal as the ground keeps it", |m, s| {
                    let now = m.layout.keeps(s.shown.speed.unwrap_or(0), s.train.place, s.ground.point);
                    let youngest = (0..).zip(s.ground.point_age).filter(|(point, _)| {
                        usize::from(*point) < m.layout.points.len()
                            && m.layout.keeps(s.shown.speed.unwrap_or(0), s.train.place, *point)
                    });
                    !now && s.ghosts.informed && youngest.map(|(_, age)| age).min() == Some(m.environment.keeps)
                })
            }
            Sight::Repeated => ("repeated", "a telegram that is repeated is used", |m, s| m.uses_repeated(s, 2)),
            Sight::Wrapped => {
                ("wrapped", "a number the counter's range further on is taken for the next one", |m, s| {
                    m.uses_repeated(s, 256 / u16::from(m.environment.in_a_cycle))
                })
            }
            Sight::OldLimit => {
                ("old-limit", "a limit is used as long after its restriction as the ground allows for", |m, s| {
                    let here = m.layout.section_at(s.train.place);
                    let fast = s.shown.speed > Some(SPEEDS[0]) && s.ghosts.informed;
                    m.layout.sections[here].restrictable && fast && s.ground.free_age == m.environment.keeps_limit
                })
            }
            Sight::Arrives => ("arrives", "it stands within its margin of the stopping point", |m, s| {
                let point = m.layout.points[usize::from(s.ground.point)];
                s.train.moved == 0 && s.train.place + m.small.margin >= point && s.train.place <= point
            }),
            Sight::Conventional => ("runs-on-codes", "it runs at the highest speed", |_, s| s.train.moved == 2),
        };
        Claim::<Self>::sometimes(name, text, condition)
    }

    pub(super) fn describe(&self) -> String {
        let small = &self.small;
        let cells: Vec<_> = self.layout.sections.iter().map(|section| section.cells.to_string()).collect();
        format!(
            "sections of {} cells of 4 m, speeds of 0, 1 and 2 cells a cycle, brake 4 m/s2; main telegrams fresh for {} and used for \
             {} cycles, sub telegrams for {}; lowest limit {} cells a cycle, worst gradient {} thousandths; margin {} cells; window {}, \
             run {}, memory {} cycles",
            cells.join(", "),
            small.fresh,
            small.life,
            small.fixed_life,
            small.lowest + 1,
            small.worst,
            small.margin,
            small.window,
            small.run,
            small.memory,
        )
    }
}
