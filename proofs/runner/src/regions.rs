//! Regions of the C of wasm2c, each written as a function, so that CBMC's path conditions stay short.
//!
//! CBMC keeps for every place the condition under which it is reached, and copies it into every step. Where two branches meet, the two
//! conditions become one again, and short, only if one is the other's negation. A jump out of a nested region passes the meeting place of
//! that region: there the conditions do not complete each other, nor at any place behind it, and each is longer than the one before. In the
//! C of one harness the conditions were 100 KB long, and CBMC compared them for most of its time.
//!
//! At the end of a *function* CBMC forgets what the function has added to the condition: whoever comes back has come in. So what is entered at
//! its first line only, and left behind its last line only, becomes a function of its own. Every jump is as it was, within its region.
//!
//! ```c
//!                                  void f_1(void) {
//!   if (a) goto inner;               if (a) goto inner;
//!   if (b) goto outer;      →        if (b) goto outer;
//!   …                                …
//! inner:                           inner:
//!   …                                …
//! outer:                           outer:;
//!   …                              }
//!                                    f_1();
//!                                    …
//! ```
//!
//! The variables of the function are then the file's. Nothing here calls itself, so that there is one of each at a time; and each that the
//! function sets to 0 when it begins is set there still.
//!
//! A place that only panics, to which many jump, would make one region of all that is between: such a jump panics where it is. A panic and the
//! way round it complete nothing either, since one of the two ways ends. So they are a function, too, of however few jumps.
//!
//! The self-test has programs of this kind, and the rewritten C is run as a program on drawn values (`traps/native.rs`, `twins.rs`).

use crate::loops::by_function;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Jumps of its own that a region has at least: the two ways round a single one complete each other.
const JUMPS: usize = 2;

/// What a panic ends with.
const PANICS: &str = "UNREACHABLE;";

/// Lines of a panic that are copied to where the jump is.
const PANIC: usize = 12;

/// Types of wasm's values.
const TYPES: [&str; 4] = ["u32 ", "u64 ", "f32 ", "f64 "];

/// The C with each region in a function.
///
/// # Errors
/// Text that is not as `loops.rs` leaves it.
pub fn apart(text: &str) -> Result<String, String> {
    by_function(text, rewrite)
}

/// The first and the last line of what must be in one region, or of a region.
type Span = (usize, usize);

/// What is entered at its first line only and left behind its last one only; the root is a whole function.
struct Region {
    span: Span,
    inner: Vec<Region>,
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

/// Place → its line.
fn places(body: &[String]) -> Result<BTreeMap<&str, usize>, String> {
    let mut places = BTreeMap::new();
    for (number, line) in body.iter().enumerate() {
        if let Some(name) = label(line)
            && places.insert(name, number).is_some()
        {
            return Err(format!("the place var_{name} is there twice"));
        }
    }
    Ok(places)
}

fn rewrite(lines: &[&str], written: &mut String) -> Result<(), String> {
    let begins = lines.iter().rposition(|line| line.ends_with('{') && !line.starts_with([' ', '#', '}']));
    let has = |what: &str| lines.iter().any(|line| line.contains(what));
    let Some(begin) = begins.filter(|_| has("FUNC_PROLOGUE;") && has("goto var_")) else {
        push_all(written, lines);
        return Ok(());
    };
    let (head, body) = (lines[begin], &lines[begin + 1..lines.len() - 1]);
    let name = head.split_once('(').and_then(|(before, _)| before.split_whitespace().last());
    let name = name.ok_or_else(|| format!("a function without a name: `{head}`"))?;
    let variables = Variables::of(name, head, body)?;
    let body = panics_where_they_are(&variables.body)?;
    let mut writer = Writer { name, body: &body, functions: Vec::new() };
    let (main, _) = writer.lines(&tree(&body)?);
    push_all(written, &lines[..begin]);
    push_all(written, &variables.declared);
    for line in writer.functions.iter().flatten() {
        push(written, &variables.renamed(line));
    }
    push(written, head);
    push_all(written, &variables.given);
    for line in &main {
        push(written, &variables.renamed(line));
    }
    push(written, lines[lines.len() - 1]);
    Ok(())
}

fn push(written: &mut String, line: &str) {
    written.push_str(line);
    written.push('\n');
}

fn push_all<T: AsRef<str>>(written: &mut String, lines: &[T]) {
    for line in lines {
        push(written, line.as_ref());
    }
}

/// The variables of a function, which become the file's.
struct Variables<'a> {
    /// The function.
    name: &'a str,
    /// Their names, without `var_`.
    names: BTreeSet<&'a str>,
    /// Their declarations.
    declared: Vec<String>,
    /// What takes over the parameters.
    given: Vec<String>,
    /// The function's lines without declarations; a variable that has a first value gets it there.
    body: Vec<String>,
}

impl<'a> Variables<'a> {
    fn of(name: &'a str, head: &'a str, lines: &[&'a str]) -> Result<Self, String> {
        let mut found = Self {
            name,
            names: BTreeSet::new(),
            declared: Vec::new(),
            given: Vec::new(),
            body: Vec::with_capacity(lines.len()),
        };
        let parameters = head.split_once('(').and_then(|(_, rest)| rest.split_once(')')).map_or("", |(inner, _)| inner);
        for (kind, parameter) in parameters.split(", ").filter_map(|parameter| parameter.split_once(' ')) {
            if let Some(short) = parameter.strip_prefix("var_") {
                found.declare(kind, short);
                found.given.push(format!("  {name}_{short} = {parameter};"));
            }
        }
        let mut kind = None;
        for line in lines {
            let trimmed = line.trim();
            let begins = TYPES.iter().find(|kind| trimmed.starts_with(&format!("{kind}var_")));
            kind = begins.map(|kind| kind.trim()).or(kind);
            let Some(of) = kind else {
                found.body.push((*line).to_owned());
                continue;
            };
            let list = begins.map_or(trimmed, |kind| &trimmed[kind.len()..]);
            for variable in list.trim_end_matches([';', ' ']).split(',').map(str::trim).filter(|each| !each.is_empty())
            {
                let (variable, first) =
                    variable.split_once(" = ").map_or((variable, None), |(name, first)| (name, Some(first)));
                let short = variable
                    .strip_prefix("var_")
                    .ok_or_else(|| format!("a declaration that wasm2c does not write: `{trimmed}`"))?;
                found.declare(of, short);
                found.body.extend(first.map(|first| format!("  {variable} = {first};")));
            }
            if trimmed.ends_with(';') {
                kind = None;
            }
        }
        Ok(found)
    }

    fn declare(&mut self, kind: &str, short: &'a str) {
        self.names.insert(short);
        self.declared.push(format!("static {kind} {}_{short};", self.name));
    }

    /// A line with the names that the file has for them.
    fn renamed(&self, line: &str) -> String {
        let mut renamed = String::with_capacity(line.len() * 2);
        let mut rest = line;
        while let Some((before, after)) = rest.split_once("var_") {
            let end =
                after.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(after.len());
            let (short, behind) = after.split_at(end);
            renamed.push_str(before);
            let _ = if self.names.contains(short) {
                write!(renamed, "{}_{short}", self.name)
            } else {
                write!(renamed, "var_{short}")
            };
            rest = behind;
        }
        renamed + rest
    }
}

/// The lines with a copy of what only panics in place of each jump to it.
fn panics_where_they_are(body: &[String]) -> Result<Vec<String>, String> {
    let places = places(body)?;
    let panic = |name: &str, line: usize| {
        let begin = places.get(name).filter(|place| **place > line)?;
        let mut copied = String::new();
        for line in body[begin + 1..].iter().filter(|line| label(line).is_none()).take(PANIC) {
            if line.contains(['{', '}']) || jump(line).is_some() || line.contains("return") {
                return None;
            }
            copied.push_str(line.trim());
            copied.push(' ');
            if line.contains(PANICS) {
                return Some(copied);
            }
        }
        None
    };
    let with = |(number, line): (usize, &String)| {
        let Some(name) = jump(line) else { return line.clone() };
        let Some(panic) = panic(name, number) else { return line.clone() };
        line.replace(&format!("goto var_{name};"), &panic)
    };
    Ok(body.iter().enumerate().map(with).collect())
}

/// What must be in one region: a jump and its place, the lines of a block in braces.
fn spans(body: &[String]) -> Result<Vec<Span>, String> {
    let places = places(body)?;
    let (mut spans, mut open) = (BTreeSet::new(), Vec::new());
    for (number, line) in body.iter().enumerate() {
        if let Some(to) = jump(line) {
            let place = *places.get(to).ok_or_else(|| format!("a jump to var_{to}, which is nowhere"))?;
            spans.insert((number.min(place), number.max(place)));
        }
        if line.trim().starts_with('}') {
            let begin = open.pop().ok_or_else(|| format!("a block that ends and does not begin: `{line}`"))?;
            spans.insert((begin, number));
        }
        if line.trim_end().ends_with('{') {
            open.push(number);
        }
    }
    if open.is_empty() { Ok(spans.into_iter().collect()) } else { Err("a block without an end".to_owned()) }
}

/// The smallest region around `span`: nothing leads into its middle, and nothing out of it.
fn closed(span: Span, spans: &[Span]) -> Span {
    let (mut begin, mut end) = span;
    loop {
        let inside = |line: usize| (begin..=end).contains(&line);
        let Some((first, last)) = spans.iter().find(|(first, last)| inside(*first) != inside(*last)) else {
            return (begin, end);
        };
        (begin, end) = (begin.min(*first), end.max(*last));
    }
}

/// The regions of a function, each in the one around it. Two that share a line are one in the other: what is smallest cannot be cut.
fn tree(body: &[String]) -> Result<Region, String> {
    let spans = spans(body)?;
    let mut regions: Vec<Span> = spans.iter().map(|span| closed(*span, &spans)).collect();
    regions.sort_by_key(|(begin, end)| (*begin, std::cmp::Reverse(*end)));
    regions.dedup();
    let mut regions = regions.into_iter().peekable();
    let last = body.len().saturating_sub(1);
    Ok(Region { span: (0, last), inner: within(last, &mut regions) })
}

/// The regions that end at the line `last` or before.
fn within(last: usize, regions: &mut std::iter::Peekable<impl Iterator<Item = Span>>) -> Vec<Region> {
    let mut found = Vec::new();
    while let Some(span) = regions.next_if(|(_, end)| *end <= last) {
        found.push(Region { span, inner: within(span.1, regions) });
    }
    found
}

/// The functions that regions have become.
struct Writer<'a> {
    name: &'a str,
    body: &'a [String],
    functions: Vec<Vec<String>>,
}

impl Writer<'_> {
    /// The lines of a region with calls in place of regions within it, and how many jumps are among them.
    fn lines(&mut self, region: &Region) -> (Vec<String>, usize) {
        let (mut lines, mut next) = (Vec::new(), region.span.0);
        for inner in &region.inner {
            self.straight(next..inner.span.0, &mut lines);
            let (within, own) = self.lines(inner);
            let whole = |line: &String| line.contains("return") || line.contains("FUNC_");
            // A panic is an end, so that the ways round it complete nothing.
            let ends = within.iter().any(|line| line.contains(PANICS));
            if own < JUMPS && !ends || within.iter().any(whole) {
                lines.extend(within);
            } else {
                lines.push(self.function(within));
            }
            next = inner.span.1 + 1;
        }
        let end = self.body.len();
        self.straight(next.min(end)..(region.span.1 + 1).min(end), &mut lines);
        let jumps = lines.iter().filter(|line| jump(line).is_some()).count();
        (lines, jumps)
    }

    /// Lines that are in no inner region. Where one of them may panic, that is a function, too.
    fn straight(&mut self, lines: std::ops::Range<usize>, written: &mut Vec<String>) {
        let body = self.body;
        for line in &body[lines] {
            let may_panic = line.trim().starts_with("if (") && line.contains(PANICS);
            written.push(if may_panic { self.function(vec![line.clone()]) } else { line.clone() });
        }
    }

    /// The call of a new function of these lines.
    fn function(&mut self, lines: Vec<String>) -> String {
        let function = format!("{}_r{}", self.name, self.functions.len() + 1);
        let head = format!("static void {function}(w2c_h* instance) {{");
        self.functions.push([vec![head], lines, vec!["}".to_owned()]].concat());
        format!("  {function}(instance);")
    }
}

#[cfg(test)]
mod tests {
    use super::apart;

    /// A function around these lines.
    fn function(lines: &[&str]) -> String {
        format!(
            "void f(w2c_h* instance, u32 var_p0) {{\n  FUNC_PROLOGUE;\n{}\n  FUNC_EPILOGUE;\n}}\n",
            lines.join("\n")
        )
    }

    #[test]
    fn what_is_entered_and_left_at_its_ends_is_a_function() {
        let text = "u32 f(w2c_h* instance, u32 var_p0) {\n  u32 var_l0 = 0, \n      var_l1 = 0;\n  FUNC_PROLOGUE;\n  u64 var_j0;\n  \
                    var_j0 = var_p0;\n  if (var_l0) {goto var_B1;}\n  if (var_l1) {goto var_B2;}\n  work();\n  var_B1:;\n  more();\n  \
                    var_B2:;\n  FUNC_EPILOGUE;\n  return var_j0;\n}\n";
        let wanted = "static u32 f_p0;\nstatic u32 f_l0;\nstatic u32 f_l1;\nstatic u64 f_j0;\nstatic void f_r1(w2c_h* instance) {\n  \
                      if (f_l0) {goto var_B1;}\n  if (f_l1) {goto var_B2;}\n  work();\n  var_B1:;\n  more();\n  var_B2:;\n}\n\
                      u32 f(w2c_h* instance, u32 var_p0) {\n  f_p0 = var_p0;\n  f_l0 = 0;\n  f_l1 = 0;\n  FUNC_PROLOGUE;\n  f_j0 = f_p0;\n  \
                      f_r1(instance);\n  FUNC_EPILOGUE;\n  return f_j0;\n}\n";
        assert_eq!(apart(text).as_deref(), Ok(wanted));
    }

    #[test]
    fn regions_are_in_one_another_and_never_cut_a_jump() {
        let text = function(&[
            "  if (a) {goto var_B1;}",
            "  if (b) {goto var_B3;}",
            "  if (c) {goto var_B2;}",
            "  var_B3:;",
            "  var_B2:;",
            "  if (d) {goto var_B1;}",
            "  var_B1:;",
        ]);
        let written = apart(&text).unwrap_or_default();
        let inner =
            "f_r1(w2c_h* instance) {\n  if (b) {goto var_B3;}\n  if (c) {goto var_B2;}\n  var_B3:;\n  var_B2:;\n}";
        let outer = "f_r2(w2c_h* instance) {\n  if (a) {goto var_B1;}\n  f_r1(instance);\n  if (d) {goto var_B1;}\n  var_B1:;\n}";
        assert!(written.contains(inner) && written.contains(outer), "{written}");
    }

    #[test]
    fn a_jump_to_a_panic_panics_where_it_is() {
        let text = function(&[
            "  if (a) {goto var_B9;}",
            "  if (b) {goto var_B9;}",
            "  goto var_B1;",
            "  var_B9:;",
            "  var_i0 = 7u;",
            "  panic(var_i0);",
            "  UNREACHABLE;",
            "  var_B1:;",
        ]);
        let written = apart(&text).unwrap_or_default();
        assert_eq!(written.matches("{var_i0 = 7u; panic(var_i0); UNREACHABLE; }").count(), 2, "{written}");
        assert_eq!(written.matches("goto var_B9;").count(), 0, "{written}");
    }

    #[test]
    fn a_panic_and_the_way_round_it_are_a_function() {
        let text = function(&[
            "  if (a) {goto var_B9;}",
            "  if (b) {goto var_B1;}",
            "  panic(var_i0);",
            "  UNREACHABLE;",
            "  var_B1:;",
            "  goto var_B2;",
            "  var_B9:;",
            "  UNREACHABLE;",
            "  var_B2:;",
        ]);
        let written = apart(&text).unwrap_or_default();
        for function in [
            "f_r1(w2c_h* instance) {\n  if (a) {UNREACHABLE; }\n}",
            "f_r2(w2c_h* instance) {\n  if (b) {goto var_B1;}\n  panic(var_i0);\n  UNREACHABLE;\n  var_B1:;\n}",
        ] {
            assert!(written.contains(function), "{written}");
        }
    }

    #[test]
    fn what_goes_on_is_no_panic() {
        let text = function(&["  if (a) {goto var_B9;}", "  var_B9:;", "  return;", "  UNREACHABLE;"]);
        assert!(apart(&text).is_ok_and(|written| written.contains("if (a) {goto var_B9;}")));
    }

    #[test]
    fn what_has_no_jumps_stays() {
        let text = function(&["  u32 var_l0 = 0;", "  work(var_l0);"]);
        assert_eq!(apart(&text).as_ref(), Ok(&text));
    }

    #[test]
    fn c_of_another_kind_is_an_error() {
        for lines in [
            vec!["  if (a) {goto var_B1;}"],
            vec!["  if (a) {goto var_B1;}", "  var_B1:;", "  var_B1:;"],
            vec!["  if (a) {goto var_B1;}", "  if (b) {", "  var_B1:;"],
            vec!["  if (a) {goto var_B1;}", "  }", "  var_B1:;"],
            vec!["  u32 var_l0 = 0, other;", "  if (a) {goto var_B1;}", "  var_B1:;"],
        ] {
            assert!(apart(&function(&lines)).is_err(), "{lines:?}");
        }
    }
}
