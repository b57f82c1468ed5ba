//! Jumps in the C of wasm2c, written so that CBMC's path conditions stay short.
//!
//! CBMC keeps for every place the condition under which it is reached. Where two branches meet, the two conditions become one again, and
//! short, if one is the other's negation. A jump out of a nested region passes the meeting place of that region: there the conditions do
//! not complete each other, nor at any place behind it, and each is longer than the one before.
//!
//! ```c
//!   if (a) goto inner;               if (a) goto inner;
//!   if (b) goto outer;      →        if (b) { via = 1; goto inner; }
//!   …                                …
//! inner:                           inner:
//!   …                                if (via == 1) { via = 0; goto outer; }
//! outer:                             …
//!                                  outer:
//! ```
//!
//! So a jump that *crosses* another (that begins behind it, and ends behind its end) goes to the end of that one first, and from there on: a
//! variable of the place says where to. The number is 0 for whoever stays. The self-test has programs of this kind, and the rewritten C is
//! run as a program on drawn values (`traps/native.rs`).

use crate::loops::by_function;
use std::collections::BTreeMap;

/// The harnesses whose C is written so: found by running them, and a matter of time only. In seconds of CPU for proof and reach, as it was and
/// so: `t_ilk_8` 107 and 67, `t_ilk_4` 99 and 47, `t_ilk_3_monotone` 34 and 5, `t_ilk_1_three` 56 and 50.
///
/// Elsewhere it can cost far more than it saves, since a place where more paths meet knows fewer constants: `t_blk_4_line` took 2 s as it was,
/// and over 60; `t_ilk_9`, `t_ilk_1_local` and `t_atc_1_connect` took 198, 106 and 51, and had no answer in 500, 150 and 150.
pub const JOINED: [&str; 4] = ["t_ilk_8", "t_ilk_1_three", "t_ilk_4", "t_ilk_3_monotone"];

/// A jump forward, as it stands in the text.
struct Jump<'a> {
    line: usize,
    to: &'a str,
}

/// The C in which no jump forward crosses another at a place where paths meet.
///
/// # Errors
/// Text that is not as `loops.rs` leaves it.
pub fn no_crossing(text: &str) -> Result<String, String> {
    by_function(text, rewrite)
}

/// The name that a line jumps to.
fn jump(line: &str) -> Option<&str> {
    line.split_once("goto var_").and_then(|(_, rest)| rest.split_once(';')).map(|(name, _)| name)
}

/// The name of the place that a line is.
fn label(line: &str) -> Option<&str> {
    let (name, rest) = line.trim().strip_prefix("var_")?.split_once(':')?;
    (rest.is_empty() || rest == ";").then_some(name)
}

/// Whether nothing goes on to the next line.
fn leaves(line: &str) -> bool {
    line.trim().starts_with("goto ")
}

/// The places of one function, and what has been sent where so far.
struct Function<'a> {
    /// The line of each place; the number of a place is that of its line.
    places: BTreeMap<&'a str, usize>,
    /// Places where more than one path meets, by line.
    meeting: BTreeMap<usize, &'a str>,
    /// The first line from which something has jumped to a place so far.
    first: BTreeMap<&'a str, usize>,
    /// For each place, where the paths that were sent there first go on to.
    onward: BTreeMap<&'a str, Vec<&'a str>>,
}

impl<'a> Function<'a> {
    fn of(lines: &[&'a str]) -> Result<(Self, Vec<Jump<'a>>), String> {
        let mut places = BTreeMap::new();
        for (number, line) in lines.iter().enumerate() {
            if let Some(name) = label(line)
                && places.insert(name, number).is_some()
            {
                return Err(format!("the place var_{name} is there twice"));
            }
        }
        let mut arrivals: BTreeMap<&str, usize> = BTreeMap::new();
        let mut jumps = Vec::new();
        for (line, text) in lines.iter().enumerate() {
            let Some(to) = jump(text) else { continue };
            let place = *places.get(to).ok_or_else(|| format!("a jump to var_{to}, which is nowhere"))?;
            if place > line {
                *arrivals.entry(to).or_default() += 1;
                jumps.push(Jump { line, to });
            } else if !leaves(text) || !to.starts_with('L') {
                return Err(format!("a jump back that is not the end of a loop: `{}`", text.trim()));
            }
        }
        let falls = |place: usize| usize::from(place > 0 && !leaves(lines[place - 1]));
        let paths = |name: &str, place: usize| arrivals.get(name).copied().unwrap_or(0) + falls(place);
        // Not the ends of a loop's rounds: how many there are is told by constants, and those must not meet with what leaves the loop.
        let ends_block = |name: &str| name.starts_with('B');
        let meeting = places.iter().filter(|(name, place)| ends_block(name) && paths(name, **place) > 1);
        let meeting = meeting.map(|(name, place)| (*place, *name)).collect();
        Ok((Self { places, meeting, first: BTreeMap::new(), onward: BTreeMap::new() }, jumps))
    }

    /// A jump from `line` to the place `to`: there, or first to the end of the nearest jump that it crosses.
    fn go(&mut self, line: usize, to: &'a str) -> String {
        let end = self.places[to];
        let crossed = |name: &&str| self.first.get(name).is_some_and(|first| *first < line);
        let via = self.meeting.range(line + 1..end).map(|(_, name)| *name).find(crossed);
        self.first.entry(via.unwrap_or(to)).or_insert(line);
        let Some(via) = via else { return format!("goto var_{to};") };
        let targets = self.onward.entry(via).or_default();
        if !targets.contains(&to) {
            targets.push(to);
        }
        format!("{{var_J{via} = {end}u; goto var_{via};}}")
    }

    /// From the place `name` onward, the farthest first: a jump that is behind another does not cross it then.
    fn leave(&mut self, name: &str) -> Vec<String> {
        let line = self.places[name];
        let mut targets = self.onward.get(name).cloned().unwrap_or_default();
        targets.sort_by_key(|to| std::cmp::Reverse(self.places[to]));
        let mut test = |to: &'a str| {
            let number = self.places[to];
            format!("  if (var_J{name} == {number}u) {{var_J{name} = 0u; {}}}", self.go(line, to))
        };
        targets.into_iter().map(&mut test).collect()
    }
}

fn rewrite(lines: &[&str], written: &mut String) -> Result<(), String> {
    let (mut function, jumps) = Function::of(lines)?;
    let mut jumps = jumps.into_iter().peekable();
    let mut body = Vec::with_capacity(lines.len());
    for (number, line) in lines.iter().enumerate() {
        if let Some(here) = jumps.next_if(|here| here.line == number) {
            body.push(line.replace(&format!("goto var_{};", here.to), &function.go(number, here.to)));
            continue;
        }
        body.push((*line).to_owned());
        if let Some(name) = label(line) {
            body.extend(function.leave(name));
        }
    }
    let declare = |name: &&str| ["  u32 var_J", name, " = 0u;\n"].concat();
    let declared: String = function.onward.keys().map(declare).collect();
    let mut declared = Some(declared).filter(|text| !text.is_empty());
    for (number, line) in body.iter().enumerate() {
        written.push_str(line);
        written.push('\n');
        // A function begins in the first column, like its end.
        if line.ends_with('{') && !line.starts_with([' ', '#']) && (number + 1 < body.len()) {
            written.push_str(&declared.take().unwrap_or_default());
        }
    }
    match declared {
        None => Ok(()),
        Some(_) => Err("jumps outside of a function".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::no_crossing;

    /// The lines of a function around these.
    fn function(lines: &[&str]) -> String {
        format!("void f(void) {{\n{}\n}}\n", lines.join("\n"))
    }

    #[test]
    fn a_jump_that_crosses_another_goes_through_its_end() {
        let text = function(&[
            "  if (var_i0) {goto var_B1;}",
            "  if (var_i1) {goto var_B2;}",
            "  var_B1:;",
            "  work();",
            "  var_B2:;",
        ]);
        let wanted = function(&[
            "  u32 var_JB1 = 0u;",
            "  if (var_i0) {goto var_B1;}",
            "  if (var_i1) {{var_JB1 = 5u; goto var_B1;}}",
            "  var_B1:;",
            "  if (var_JB1 == 5u) {var_JB1 = 0u; goto var_B2;}",
            "  work();",
            "  var_B2:;",
        ]);
        assert_eq!(no_crossing(&text), Ok(wanted));
    }

    #[test]
    fn what_is_nested_stays() {
        let text = function(&[
            "  if (var_i1) {goto var_B2;}",
            "  if (var_i0) {goto var_B1;}",
            "  var_B1:;",
            "  work();",
            "  var_B2:;",
            "  var_L3: ",
            "  if (var_i0) {goto var_C3;}",
            "  goto var_E3;",
            "  var_C3:;",
            "  goto var_L3;",
            "  var_E3:;",
        ]);
        assert_eq!(no_crossing(&text).as_ref(), Ok(&text));
    }

    #[test]
    fn two_that_go_on_do_so_the_farthest_first() {
        let text = function(&[
            "  if (var_i0) {goto var_B1;}",
            "  switch (var_i1) {",
            "    case 0: goto var_B2;",
            "    default: goto var_B3;",
            "  }",
            "  var_B1:;",
            "  var_B2:;",
            "  var_B3:;",
        ]);
        let written = no_crossing(&text).unwrap_or_default();
        let order: Vec<_> = written.lines().filter(|line| line.contains("if (var_JB1 ==")).collect();
        assert!(
            order.len() == 2 && order[0].contains("goto var_B3;") && order[1].contains("goto var_B2;"),
            "{written}"
        );
    }

    #[test]
    fn c_of_another_kind_is_an_error() {
        for text in [
            "void f(void) {\n  goto var_B1;\n}\n",
            "void f(void) {\n  var_B1:;\n  goto var_B1;\n}\n",
            "void f(void) {\n  var_L1:;\n  if (x) {goto var_L1;}\n}\n",
            "void f(void) {\n  var_B1:;\n  var_B1:;\n}\n",
        ] {
            assert!(no_crossing(text).is_err(), "{text}");
        }
    }
}
