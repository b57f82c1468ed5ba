//! The list of assumptions of a harness is what it assumes: what its run supposes, what is said to be built in, and what carries its bound.

use atc_proofs::Harness;
use atc_prover::{harnesses, native, root};
use proc_macro2::{Ident, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::parse::Parser;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Block, Expr, ExprBinary, ExprLit, ExprMethodCall, Lit, Local, Macro, Pat, Stmt, Token};

#[derive(serde::Deserialize)]
struct Entries {
    assumption: Vec<Entry>,
}

#[derive(serde::Deserialize)]
struct Entry {
    id: String,
    #[serde(default)]
    bounds: Vec<String>,
}

fn entries() -> Vec<Entry> {
    let text = std::fs::read_to_string(root().join("spec/assumptions.toml")).unwrap();
    toml::from_str::<Entries>(&text).unwrap().assumption
}

/// What is wrong with the list of a harness whose run supposes `supposed`.
fn faults(harness: &Harness, supposed: &BTreeSet<&str>, entries: &[Entry]) -> Vec<String> {
    let mut faults = Vec::new();
    let declared: BTreeSet<&str> = harness.assumptions.iter().copied().collect();
    let built_in: BTreeSet<&str> = harness.built_in.iter().map(|(id, _)| *id).collect();
    let carries =
        |entry: &&Entry| entry.bounds.iter().any(|start| harness.bound.split(", ").any(|part| part.starts_with(start)));
    let carriers: BTreeSet<&str> = entries.iter().filter(carries).map(|entry| entry.id.as_str()).collect();
    let mut fault = |id: &str, text: &str| faults.push(format!("{}: {id} {text}", harness.name));
    if declared.len() < harness.assumptions.len() || built_in.len() < harness.built_in.len() {
        fault("an assumption", "is listed twice");
    }
    for id in supposed.difference(&declared) {
        fault(id, "is supposed and not listed");
    }
    for id in built_in.difference(&declared) {
        fault(id, "is built in and not listed");
    }
    for id in built_in.intersection(supposed) {
        fault(id, "is supposed, and so need not be built in");
    }
    for id in declared.iter().filter(|id| !supposed.contains(*id) && !built_in.contains(*id) && !carriers.contains(*id))
    {
        fault(id, "is listed, and neither supposed nor built in, nor does it carry the bound");
    }
    for id in declared.iter().filter(|id| !entries.iter().any(|entry| entry.id == **id)) {
        fault(id, "is not in spec/assumptions.toml");
    }
    for (id, reason) in harness.built_in.iter().filter(|(_, reason)| reason.trim().is_empty()) {
        fault(id, &format!("is built in, and nobody says how: \"{reason}\""));
    }
    faults
}

#[test]
fn a_list_of_assumptions_is_what_the_harness_assumes() {
    let entries = entries();
    let (mut all, mut some) = (Vec::new(), 0);
    for harness in harnesses() {
        let mut supposed = native::supposed(harness, 50);
        // What stands in an arm that is drawn rarely takes longer.
        if !faults(harness, &supposed, &entries).is_empty() {
            supposed = native::supposed(harness, 20_000);
        }
        some += usize::from(!supposed.is_empty());
        all.extend(faults(harness, &supposed, &entries));
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
    assert!(some >= 25, "only {some} harnesses suppose anything");
}

#[test]
fn a_list_that_is_too_short_or_too_long_is_found() {
    let harness = |assumptions, built_in| Harness { assumptions, built_in, ..*harnesses()[0] };
    let entries = entries();
    let find = |harness: Harness, supposed: &[&'static str]| {
        faults(&harness, &supposed.iter().copied().collect(), &entries).join("\n")
    };
    let none: &[(&str, &str)] = &[];
    assert_eq!(find(harness(&["gravity"], none), &["gravity"]), "");
    assert_eq!(find(harness(&["gravity"], &[("gravity", "in the numbers")]), &[]), "");
    for (made, supposed, expected) in [
        (harness(&[], none), &["gravity"][..], "supposed and not listed"),
        (harness(&["gravity"], none), &[], "neither supposed nor built in"),
        (harness(&[], &[("gravity", "in the numbers")]), &[], "built in and not listed"),
        (harness(&["gravity"], &[("gravity", "in the numbers")]), &["gravity"], "need not be built in"),
        (harness(&["gravity"], &[("gravity", " ")]), &[], "nobody says how"),
        (harness(&["gravity", "gravity"], none), &["gravity"], "listed twice"),
        (harness(&["levity"], none), &["levity"], "not in spec/assumptions.toml"),
        // It carries the bounds of other harnesses.
        (harness(&["four-speeds"], none), &[], "nor does it carry the bound"),
    ] {
        let found = find(made, supposed);
        assert!(found.contains(expected), "{expected}: {found}");
    }
}

/// What plain `assume` may say besides the forms that [`is_validity`] knows: file, text, and why it says nothing about the world. The text is that
/// of the condition; of what has no value, or of the branch, where the condition is `false`.
const LISTED: &[(&str, &str, &str)] = &[
    ("interlocking/room.rs", "train.stops()", AGAIN),
    ("interlocking/room.rs", "train.is_known(age)", AGAIN),
    ("interlocking/room.rs", "run <= train.room", "what is claimed just before, of this code or of another one"),
    ("interlocking/room.rs", "later.stops()", "what is claimed just before, of this code or of another one"),
    ("interlocking/room.rs", "0 < weaker", "a range: a train that has a brake"),
    ("interlocking/room.rs", "weaker <= between", "the case: the brake between"),
    ("interlocking/room.rs", "between <= stronger", "the case: the brake between"),
    ("interlocking/room.rs", "holds(weaker)", "the case: the distance is enough for the weaker brake"),
    ("interlocking/room.rs", "holds(stronger)", "the case: the distance is enough for the stronger brake"),
    ("interlocking/device.rs", "layout()", "a layout of constants, which the constructor takes"),
    ("interlocking/track.rs", "before.counts.0 <= clear", "a range: no count is over T_clear"),
    ("interlocking/track.rs", "before.counts.1 <= clear", "a range: no count is over T_clear"),
    ("interlocking/track.rs", "before.holds(loss)", AGAIN),
    ("wayside/counter.rs", "ghost.wrapping_add(since.to_le_bytes()[0]) == main.0", AGAIN),
    ("wayside/consent.rs", "life.0 <= MAX_TICKS", "a range: a time that the constructor accepts"),
    ("wayside/consent.rs", "!granted || sent <= u32::from(before.age.0)", AGAIN),
    ("train/facing.rs", "own(&before)", AGAIN),
    ("wayside/said.rs", "fixed.left.section != fixed.right.section", "what the constructor guarantees (WAY-19)"),
    (
        "wayside/speech.rs",
        "match told.main.route { Route::OpenFor(distance) => front <= u32::from(distance.0), Route::Closed => front == 0, }",
        "the train that the theorem is about: it stops where it is told to",
    ),
    ("wayside/speech.rs", "stale || !occupied || !grants", CASE),
    (
        "wayside/occupancy.rs",
        "!known || held >= u32::from(self.train)",
        "what the constructor guarantees (WAY-14, `way_join`)",
    ),
    ("wayside/joint.rs", "made.is_some()", "a joint that the constructor accepts"),
    (
        "wayside/joint.rs",
        "behind == 0 || behind < u32::from(line.train)",
        "the metres under the train, which the claim is about",
    ),
    ("wayside/joint.rs", "front_on.is_some()", "the front is on the line: what the claim is about"),
    ("wayside/occupancy.rs", "head >= line.entry", CASE),
    ("wayside/occupancy.rs", "u32::from(into) < own", "the front is in its circuit"),
    ("wayside/occupancy.rs", "under < head", "the circuits that the claim is about"),
    ("wayside/occupancy.rs", "between < u32::from(length)", "the circuits under the train, which the claim is about"),
    ("wayside/direction.rs", "counted.is_kept(directions.0, directions.1)", AGAIN),
    ("train/stop.rs", "knows_main(main)", "a rank that the line has: others are no telegram (T-TRN-4)"),
    ("train/stop.rs", "fixed == (case == 2)", CASE),
    ("train/distance.rs", "border == at_border", CASE),
    ("position.rs", "position.is_some()", "a device that the constructor accepts"),
    ("duplex.rs", "word < words", "a range: the words that there are"),
    ("duplex.rs", "bit < if word == words - 1 { 8 } else { 16 }", "a range: the bits that a word has"),
    ("supervision.rs", "plausible(&cycle)", CASE),
    ("aspect/bound.rs", "unheard <= expiry", "a range: the ghost counts so far"),
    ("aspect/bound.rs", "covers(lane(&cycle.before, rank), unheard)", AGAIN),
    ("aspect/bound.rs", "silence <= expiry", "a range: the ghost counts so far"),
    ("aspect/bound.rs", "every(&cycle, false, |lane| covers(lane, silence))", AGAIN),
    ("aspect/carry.rs", "!has(matter, rank)", CASE),
    (
        "aspect/carry.rs",
        "ranks::<FEW>() & (four.accepted | four.last | four.credited | four.dropped) == four.accepted | four.last | four.credited | four.dropped",
        "the state that the theorem is about: the aspects from rank 4 on are idle",
    ),
    ("aspect/compare.rs", "more_heard(&asked, &plain, &more, extra)", AGAIN),
    ("aspect/compare.rs", "not_less_safe(&new, &old)", AGAIN),
    ("aspect/evidence.rs", "before.matches(asked, was)", AGAIN),
    ("aspect/gap.rs", "asked.shortened <= run", "a range: the run of an aspect that is accepted and heard"),
    ("aspect/gap.rs", "run <= asked.operate", "a range: the run of an aspect that is accepted and heard"),
    ("aspect/gap.rs", "heard == 0 || gap > 0", "a range: what is heard after an interruption comes after one"),
    ("aspect/gap.rs", "gap > 0", "a range: an interruption has a cycle"),
    ("aspect/mod.rs", "usize::from(rank) < N", "a range: the ranks that there are"),
    ("aspect/table.rs", "speeds[0] < speeds[1]", "what the constructor accepts"),
    ("aspect/table.rs", "speeds[1] < speeds[2]", "what the constructor accepts"),
    ("aspect/table.rs", "speeds[2] < speeds[3]", "what the constructor accepts"),
    ("block/count.rs", "!counted || !under(before.count, before.pending, before.check_in_for, trains, since)", AGAIN),
    (
        "block/count.rs",
        "!leaves || trains > 0 || enters",
        "what it is to leave: the train was in the block, or has entered in this cycle",
    ),
    ("block/geometry.rs", "nose < count", "a range: the sections that there are"),
    ("block/line.rs", "has(heads, head)", CASE),
    ("block/line.rs", "distance > head", CASE),
    ("block/line.rs", "distance <= hold", CASE),
    ("block/report.rs", "heads & !cycle.output.occupied.bits() != 0", CASE),
    ("block/reset.rs", "input.reset.map(|number| u32::from(number.0))", CASE),
    ("interlocking/ahead.rs", "!confirmed.meets(reaches(&scene.earlier))", AGAIN),
    ("interlocking/ahead.rs", "counted(&still, count(&device.points))", AGAIN),
    ("interlocking/ahead.rs", "serves(&still, &scene.earlier)", AGAIN),
    ("interlocking/atc.rs", "numbers.0 != numbers.1", CASE),
    ("interlocking/cycle.rs", "matches!(output.answer, Some(Err(_)))", CASE),
    (
        "interlocking/meeting.rs",
        "!left || scene.earlier.tail >= ground.over",
        "a range: where a train is that has left the line",
    ),
    (
        "interlocking/meeting.rs",
        "!out || segment.throat.contains(scene.route.last())",
        "a rule of the constructor (LAY-2)",
    ),
    ("interlocking/meeting.rs", "holds(&scene, device, earlier, before)", AGAIN),
    ("interlocking/meeting.rs", "is_valid(&scene, device)", "a valid state"),
    ("interlocking/meeting.rs", "segment.length > 0", "the case that the theorem is about: there is a line"),
    ("interlocking/point.rs", "count(counted) <= stood", AGAIN),
    ("interlocking/route.rs", "before.phase != Phase::Idle", CASE),
    ("interlocking/scene.rs", "!path.meets(ground.overlap)", "a rule of the constructor (LAY-2)"),
    ("interlocking/scene.rs", "!route.approach.meets(path.or(ground.overlap))", "a rule of the constructor (LAY-2)"),
    ("interlocking/scene.rs", "ground.entry.is_one()", "a rule of the constructor (LAY-2)"),
    ("interlocking/scene.rs", "holds(&train, &ground, &before)", AGAIN),
    ("interlocking/scene.rs", "route.exists()", "the case that the theorem is about: there is a route"),
    ("interlocking/scene.rs", "train.is_one(&ground)", AGAIN),
    ("interlocking/signal.rs", "state.phase != Phase::Idle", CASE),
    ("interlocking/start.rs", "!(on_line && given)", AGAIN),
    ("interlocking/start.rs", "before.works.confirmed.bits() & under.bits() == 0", AGAIN),
    ("interlocking/table.rs", "damage == 0", CASE),
    ("interlocking/table.rs", "written == scene.now", CASE),
    ("interlocking/track.rs", "clear == 0", "what the constructor accepts"),
    (
        "interlocking/forgotten.rs",
        "besides(&plan, &before, earlier, gone)",
        "what each harness has of its own: quiet and free, or aside, which it claims again, and the bound on the paths of t_ilk_12_unswept",
    ),
    (
        "interlocking/forgotten.rs",
        "!route.cab_signalled",
        "the case that the theorem is about: a driver who goes by signals",
    ),
    (
        "interlocking/forgotten.rs",
        "!ground.out || segment.length > 0 && segment.throat == route.last() && route.overlap.circuits.is_empty()",
        "a rule of the constructor (LAY-2)",
    ),
    (
        "interlocking/forgotten.rs",
        "(path & route.overlap.circuits.bits() | (path | route.overlap.circuits.bits()) & route.entry.bits()) == 0",
        "a rule of the constructor (LAY-2)",
    ),
    ("interlocking/forgotten.rs", "earlier.is_one(&ground)", AGAIN),
    ("interlocking/forgotten.rs", "holds(earlier, &ground, &before)", AGAIN),
    ("interlocking/forgotten.rs", "route.entry.is_one()", "a rule of the constructor (LAY-2)"),
    ("interlocking/forgotten.rs", "route.exists()", "the case that the theorem is about: there is a route"),
    ("interlocking/works.rs", "!was_confirmed || !on_line || protects(&before)", AGAIN),
    ("permitted/memory.rs", "counted(&cycle.before, ghost)", AGAIN),
    ("permitted/permission.rs", "state.fixed.iter().flatten().all(|fixed| fixed.section != target.section)", CASE),
    ("position/bounds.rs", "dividend - product < worth + worth", AGAIN),
    ("position/bounds.rs", "dividend <= 1 << 28", "a range: no dividend is greater"),
    ("position/bounds.rs", "over <= rise", "a range: a part is not more than the whole"),
    ("position/bounds.rs", "product <= dividend", AGAIN),
    ("position/inclusion.rs", "least <= most", CASE),
    ("position/inclusion.rs", "less <= least", CASE),
    ("position/inclusion.rs", "most <= more", CASE),
    ("position/interval.rs", "curves.highest[knot] < curves.highest[knot + 1]", CASE),
    ("position/interval.rs", "curves.lowest[knot] < curves.lowest[knot + 1]", CASE),
    ("position/interval.rs", "far < far_end", "what `t_pos_1` proves of the spans that are told"),
    ("position/interval.rs", "far <= most", "what `t_pos_1` proves of the spans that are told"),
    ("position/interval.rs", "least <= most", "what `t_pos_1_levels` proves of the bounds"),
    ("position/interval.rs", "near < near_end", "what `t_pos_1` proves of the spans that are told"),
    ("position/interval.rs", "near_end >= least", "what `t_pos_1` proves of the spans that are told"),
    ("position/odometer.rs", "was <= far", AGAIN),
    ("telegram/counter.rs", "any_heard(e)", CASE),
    ("telegram/counter.rs", "!known || received.explains(&before, sequence)", AGAIN),
    ("telegram/counter.rs", "knows(&before, row, silent)", AGAIN),
    ("train/distance.rs", "before.position.is_none_or(|interval| was <= i64::from(interval.farthest().0))", AGAIN),
    ("train/mod.rs", "moved.is_some()", "what the constructor of a movement accepts, either way"),
    ("train/silence.rs", "counted(&cycle.before, silent)", AGAIN),
];

const CASE: &str = "the case that the theorem is about";
const AGAIN: &str = "the induction hypothesis, which is claimed again after the cycle";

/// The functions that make a value of the kernel, and say whether it is one.
const MAKERS: &[&str] = &["new", "brake", "from_ticks", "with_what_proofs_need"];

/// The files of the harnesses, and what each is called in [`LISTED`].
fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else {
            into.push(path);
        }
    }
}

/// The text of a piece of source, on one line.
fn text(piece: &impl Spanned) -> String {
    piece.span().source_text().unwrap().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What a source assumes and supposes.
#[derive(Default)]
struct Found {
    /// The conditions of plain `assume` that are of no known form.
    others: Vec<String>,
    /// How many there are in all.
    assumed: usize,
    /// The first arguments of `suppose`.
    supposed: Vec<String>,
    /// What the names of the function stand for that is looked at.
    names: BTreeMap<String, Expr>,
    /// What has no value where the present block is reached, or the condition of the branch; innermost last.
    because: Vec<Expr>,
}

impl Found {
    fn of(source: &str) -> Self {
        let mut found = Self::default();
        found.visit_file(&syn::parse_file(source).unwrap());
        found
    }

    fn assume(&mut self, condition: &Expr) {
        self.assumed += 1;
        if matches!(condition, Expr::Lit(_)) && text(condition) == "false" {
            match self.because.last() {
                Some(because) if makes(because, &self.names) => {}
                Some(because) => self.others.push(text(because)),
                None => self.others.push("false".to_owned()),
            }
        } else {
            let others = parts(condition, &self.names).into_iter().filter(|part| !is_validity(part, &self.names));
            self.others.extend(others.map(|part| text(&part)));
        }
    }
}

/// What must hold together, with names in the place of which stands what they are.
fn parts(condition: &Expr, names: &BTreeMap<String, Expr>) -> Vec<Expr> {
    match condition {
        Expr::Binary(binary) if matches!(binary.op, BinOp::And(_)) => {
            [parts(&binary.left, names), parts(&binary.right, names)].concat()
        }
        Expr::Paren(inner) => parts(&inner.expr, names),
        Expr::Path(path) => match path.path.get_ident().and_then(|name| names.get(&name.to_string())) {
            Some(one) => parts(one, names),
            None => vec![condition.clone()],
        },
        other => vec![other.clone()],
    }
}

/// Whether an expression is a call of a maker, or a tuple, an array or a name of such.
fn makes(made: &Expr, names: &BTreeMap<String, Expr>) -> bool {
    let is_maker = |name: &Ident| MAKERS.iter().any(|maker| name == maker);
    match made {
        Expr::Call(call) => match &*call.func {
            Expr::Path(path) => path.path.segments.last().is_some_and(|last| is_maker(&last.ident)),
            _ => false,
        },
        Expr::Tuple(tuple) => tuple.elems.iter().all(|one| makes(one, names)),
        Expr::MethodCall(call) if call.method == "ok" => makes(&call.receiver, names),
        // What is made of each of several sizes.
        Expr::MethodCall(call) if call.method == "map" || call.method == "and_then" => match call.args.first() {
            Some(Expr::Closure(each)) => match &*each.body {
                Expr::Block(block) => match block.block.stmts.last() {
                    Some(Stmt::Expr(last, None)) => makes(last, names),
                    _ => false,
                },
                body => makes(body, names),
            },
            _ => false,
        },
        Expr::Path(path) => {
            path.path.get_ident().and_then(|name| names.get(&name.to_string())).is_some_and(|one| makes(one, names))
        }
        _ => false,
    }
}

/// Whether a condition says no more than that a value is valid, or a number in a fixed range.
fn is_validity(condition: &Expr, names: &BTreeMap<String, Expr>) -> bool {
    let fixed = |bound: &Expr| match bound {
        Expr::Lit(_) => true,
        Expr::Path(path) => path
            .path
            .segments
            .last()
            .is_some_and(|last| last.ident.to_string().chars().all(|one| one.is_uppercase() || one == '_')),
        _ => false,
    };
    match condition {
        Expr::MethodCall(call) => match call.method.to_string().as_str() {
            "is_valid" => true,
            "is_some" | "is_ok" => makes(&call.receiver, names),
            "contains" => matches!(&*call.receiver, Expr::Paren(range) if matches!(&*range.expr, Expr::Range(_))),
            _ => false,
        },
        Expr::Binary(binary) => match binary.op {
            BinOp::Lt(_) | BinOp::Le(_) => matches!(&*binary.left, Expr::Path(_)) && fixed(&binary.right),
            _ => false,
        },
        // Where a conjunction begins that grows in a loop.
        Expr::Lit(_) => text(condition) == "true",
        _ => false,
    }
}

impl<'a> Visit<'a> for Found {
    fn visit_item_fn(&mut self, function: &'a syn::ItemFn) {
        self.names.clear();
        visit::visit_item_fn(self, function);
    }

    fn visit_macro(&mut self, called: &'a Macro) {
        // The body of a harness, and those of macros that make harnesses.
        if let Some(TokenTree::Group(body)) = called.tokens.clone().into_iter().last()
            && called.path.is_ident("harness")
        {
            self.names.clear();
            let body = Block::parse_within.parse2(body.stream()).unwrap();
            // The trees live as long as the call: what is kept of them is copied.
            let mut inside = Self { names: BTreeMap::new(), ..std::mem::take(self) };
            for statement in &body {
                inside.visit_stmt(statement);
            }
            *self = inside;
        }
    }

    fn visit_local(&mut self, local: &'a Local) {
        let Some(init) = &local.init else { return };
        self.visit_expr(&init.expr);
        if let Some((_, otherwise)) = &init.diverge {
            self.because.push((*init.expr).clone());
            self.visit_expr(otherwise);
            self.because.pop();
        }
        if let Pat::Ident(name) = &local.pat {
            self.names.insert(name.ident.to_string(), (*init.expr).clone());
        }
    }

    fn visit_expr_if(&mut self, branch: &'a syn::ExprIf) {
        self.visit_expr(&branch.cond);
        self.because.push((*branch.cond).clone());
        self.visit_block(&branch.then_branch);
        self.because.pop();
        if let Some((_, otherwise)) = &branch.else_branch {
            self.visit_expr(otherwise);
        }
    }

    fn visit_expr_binary(&mut self, binary: &'a ExprBinary) {
        visit::visit_expr_binary(self, binary);
        let name = |path: &syn::ExprPath| path.path.get_ident().map(ToString::to_string);
        if let (BinOp::BitAndAssign(_), Expr::Path(path)) = (&binary.op, &*binary.left)
            && let Some((name, before)) = name(path).and_then(|name| self.names.remove_entry(&name))
        {
            let op = BinOp::And(Token![&&](binary.span()));
            let (left, right) = (Box::new(before), binary.right.clone());
            self.names.insert(name, Expr::Binary(ExprBinary { attrs: Vec::new(), left, op, right }));
        }
    }

    fn visit_expr_method_call(&mut self, call: &'a ExprMethodCall) {
        let own = matches!(&*call.receiver, Expr::Path(path) if path.path.is_ident("self"));
        match (call.method.to_string().as_str(), call.args.first()) {
            ("assume", Some(condition)) if !own => self.assume(condition),
            ("suppose", Some(Expr::Lit(ExprLit { lit: Lit::Str(id), .. }))) => self.supposed.push(id.value()),
            ("suppose", Some(id)) => self.supposed.push(format!("not a name: {}", text(id))),
            _ => {}
        }
        visit::visit_expr_method_call(self, call);
    }
}

#[test]
fn what_is_assumed_without_a_name_says_nothing_about_the_world() {
    let folder = root().join("proofs/src");
    let mut files = Vec::new();
    sources(&folder, &mut files);
    let entries = entries();
    let (mut faults, mut unused) = (Vec::new(), LISTED.iter().collect::<Vec<_>>());
    let (mut assumed, mut supposed) = (0, 0);
    for path in files {
        let file = path.strip_prefix(&folder).unwrap().to_string_lossy().replace('\\', "/");
        let source = std::fs::read_to_string(&path).unwrap();
        let found = Found::of(&source);
        for other in &found.others {
            unused.retain(|(there, text, _)| (*there, *text) != (file.as_str(), other.as_str()));
            let is_listed =
                LISTED.iter().any(|(there, text, why)| (*there, *text) == (file.as_str(), other) && !why.is_empty());
            if !is_listed {
                faults.push(format!(
                    "{file}: assume({other}): suppose it, or say in the test why it is nothing about the world"
                ));
            }
        }
        for id in found.supposed.iter().filter(|id| !entries.iter().any(|entry| entry.id == **id)) {
            faults.push(format!("{file}: suppose: {id} is not in spec/assumptions.toml"));
        }
        // Nothing is out of sight in a macro.
        let there = |what: &str| source.matches(&format!("e.{what}(")).count();
        if (there("assume"), there("suppose")) != (found.assumed, found.supposed.len()) {
            faults.push(format!(
                "{file}: only {} and {} of assume and suppose were looked at",
                found.assumed,
                found.supposed.len()
            ));
        }
        assumed += found.assumed;
        supposed += found.supposed.len();
    }
    faults.extend(unused.iter().map(|(file, text, _)| format!("{file}: nobody assumes {text} any more")));
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(assumed > 80 && supposed > 40, "only {assumed} and {supposed}");
}

#[test]
fn an_assumption_without_a_name_is_found_wherever_it_stands() {
    for (body, others) in [
        ("e.assume(state.is_valid(times));", 0),
        ("let valid = state.is_valid(times); e.assume(valid);", 0),
        ("let made = Block::new(1).ok(); e.assume(made.is_some());", 0),
        ("let Ok(made) = Block::new(1) else { return e.assume(false) };", 0),
        ("e.assume(word <= 0xFF); e.assume(wrong < FRAME_BITS); e.assume((1..=16).contains(&sections));", 0),
        ("let mut valid = true; valid &= state.is_valid(times); e.assume(valid);", 0),
        ("let mut valid = true; valid &= !enters; e.assume(valid);", 1),
        ("e.assume(!enters || check_in);", 1),
        ("e.assume(state.is_valid(times) && !enters);", 1),
        ("let valid = !enters; e.assume(valid);", 1),
        ("let valid = state.is_valid(times); let valid = !enters; e.assume(valid);", 1),
        ("e.assume(count < trains);", 1),
        ("e.assume(heard.is_some());", 1),
        ("let Some(train) = train else { return e.assume(false) };", 1),
        ("if enters { return e.assume(false); }", 1),
        ("match kind { 0 => e.assume(!enters), _ => {} }", 1),
        ("e.assume(false);", 1),
    ] {
        for source in [format!("fn f() {{ {body} }}"), format!("harness! {{ f(e) claims {{ C: \"\" }} {{ {body} }} }}")]
        {
            assert_eq!(Found::of(&source).others.len(), others, "{source}");
        }
    }
    let found = Found::of("fn f() { e.suppose(\"gravity\", !enters); e.suppose(id, true); }");
    assert_eq!(found.supposed, ["gravity", "not a name: id"]);
}
