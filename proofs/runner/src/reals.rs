//! The algebra of a theorem about motion, over all real numbers: Z3 on `proofs/reals/NAME.smt2`.
//!
//! The file has definitions first, then parts, each below a line `; lemma NAME`, `; claim NAME` or `; cover NAME`. A part defines `NAME.if`, and
//! but for a cover `NAME.then`. A lemma and a claim say that the one follows from the other, for all numbers; a claim may use the lemmas. Claims
//! and cover points are those of the harness of the same name.
//!
//! A claim is *proved* if Z3 finds no number for which it is false, and some for which its `if` is true; the same of every lemma. No answer, an unknown
//! answer, or one too few is no proof.

use crate::campaign::unproven;
use crate::process::{End, Job, Limits, run};
use crate::report::{Campaign, HarnessResult, SCHEMA, Verdict};
use crate::tools::Tools;
use crate::{Options, provenance, root};
use atc_proofs::Harness;
use std::path::Path;
use std::time::Instant;

/// The name of the engine.
pub const ENGINE: &str = "reals";

/// Stands for an answer that did not come in time.
const LATE: &str = "late";

/// What a part of a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Lemma,
    Claim,
    Cover,
}

/// A question to Z3, and what must be the answer.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Asked {
    kind: Kind,
    name: String,
    /// Whether it is asked for numbers for which its `if` is true.
    reach: bool,
    /// What is supposed.
    asserts: String,
}

/// The harnesses with a file, among `harnesses`.
pub fn with_file<'a>(root: &Path, harnesses: &[&'a Harness]) -> Vec<&'a Harness> {
    harnesses.iter().copied().filter(|harness| file(root, harness.name).is_file()).collect()
}

fn file(root: &Path, name: &str) -> std::path::PathBuf {
    root.join("proofs").join("reals").join(format!("{name}.smt2"))
}

/// Proves those of `harnesses` that have a file.
///
/// # Errors
/// The sources cannot be read. (What is not proved is a result.)
pub fn campaign(options: &Options, harnesses: &[&Harness]) -> Result<Campaign, String> {
    let (root, started) = (root(), Instant::now());
    let tools = Tools::find(&root);
    let versions = tools.as_ref().map(|tools| tools.versions.clone()).unwrap_or_default();
    let mut provenance = provenance::of(&root, versions, Vec::new())?;
    let mut results = Vec::new();
    for harness in with_file(&root, harnesses) {
        let path = file(&root, harness.name);
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        results.push(match &tools {
            Ok(tools) if tools.versions.contains_key("z3") => prove(tools, options, harness, &text),
            Ok(_) => unproven(
                harness,
                ENGINE,
                Verdict::NotRun,
                "Z3 is not here: ci/install-provers says what would help".to_owned(),
            ),
            Err(reason) => unproven(harness, ENGINE, Verdict::NotRun, reason.clone()),
        });
    }
    provenance.seconds = started.elapsed().as_secs_f64();
    Ok(Campaign { schema: SCHEMA, engine: ENGINE.to_owned(), provenance, harnesses: results })
}

/// What Z3 says of the parts of `text`, which is that of a file.
pub fn prove(tools: &Tools, options: &Options, harness: &Harness, text: &str) -> HarnessResult {
    let answered = questions(text).and_then(|asked| {
        let (mut answers, mut seconds) = (Vec::new(), 0.0);
        for one in &asked {
            let (answer, took) = ask(tools, options, harness.name, &format!("{text}\n{}(check-sat)\n", one.asserts))?;
            answers.push(answer);
            seconds += took;
        }
        Ok((asked, answers, seconds))
    });
    match answered {
        Ok((asked, answers, seconds)) => conclude(harness, &asked, &answers, seconds),
        Err(reason) => unproven(harness, ENGINE, Verdict::Error, reason),
    }
}

/// The questions of a file. Each is for a Z3 of its own: of several in a row it tries other ways, which do not end.
fn questions(text: &str) -> Result<Vec<Asked>, String> {
    let (mut asked, mut lemmas) = (Vec::<Asked>::new(), String::new());
    only_definitions(text)?;
    for line in text.lines() {
        let words: Vec<_> = line.split(' ').collect();
        let (kind, name) = match words[..] {
            [";", "lemma", name] => (Kind::Lemma, name),
            [";", "claim", name] => (Kind::Claim, name),
            [";", "cover", name] => (Kind::Cover, name),
            _ => continue,
        };
        if asked.iter().any(|one| one.name == name) {
            return Err(format!("two parts are called {name}"));
        }
        let mut question =
            |reach: bool, asserts: String| asked.push(Asked { kind, name: name.to_owned(), reach, asserts });
        question(true, format!("(assert {name}.if)\n"));
        if kind != Kind::Cover {
            let known = if kind == Kind::Claim { lemmas.as_str() } else { "" };
            question(false, format!("{known}(assert {name}.if)\n(assert (not {name}.then))\n"));
        }
        if kind == Kind::Lemma {
            lemmas.extend(["(assert (=> ", name, ".if ", name, ".then))\n"]);
        }
    }
    Ok(asked)
}

/// What a file asks or supposes itself would be in every question; so would a new meaning of a word of the language.
fn only_definitions(text: &str) -> Result<(), String> {
    // What is quoted may have a bracket or a semicolon in it.
    if text.contains(['|', '"']) {
        return Err("a file of definitions has nothing quoted".to_owned());
    }
    let code: Vec<_> = text.lines().map(|line| line.split(';').next().unwrap_or_default()).collect();
    let (mut depth, mut form) = (0_usize, String::new());
    for letter in code.join(" ").chars() {
        depth = if letter == '(' { depth + 1 } else { depth.saturating_sub(usize::from(letter == ')')) };
        form.push(letter);
        if depth > 0 || form.trim().is_empty() {
            continue;
        }
        let words: Vec<_> = form.split_whitespace().collect();
        let is_right = match words[..] {
            ["(declare-const", name, "Real)"] | ["(define-fun", name, _, ..] => is_own(name),
            _ => false,
        };
        if !is_right {
            let first = form.trim();
            return Err(format!("a file has definitions of its own words only, and not {first}"));
        }
        form.clear();
    }
    if depth == 0 && form.trim().is_empty() { Ok(()) } else { Err("a definition does not end".to_owned()) }
}

/// Whether a name is of letters and dots, and no word that Z3 knows.
fn is_own(name: &str) -> bool {
    let known =
        ["not", "and", "or", "xor", "ite", "true", "false", "distinct", "div", "mod", "abs", "let", "forall", "exists"];
    name.chars().all(|letter| letter.is_ascii_alphabetic() || letter == '.') && !known.contains(&name)
}

/// Z3's answer, and the CPU time that it took.
fn ask(tools: &Tools, options: &Options, name: &str, script: &str) -> Result<(String, f64), String> {
    let folder = options.folder.join(ENGINE);
    let (input, output) = (folder.join(format!("{name}.smt2")), folder.join(format!("{name}.txt")));
    std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(&input, script))
        .map_err(|error| format!("{}: {error}", input.display()))?;
    let limits = Limits { cpu: options.limit, memory_kib: 8 << 20 };
    let (program, arguments) = (tools.path("z3"), [input.display().to_string()]);
    let job =
        Job { program: &program, arguments: &arguments, variables: &[], folder: &folder, output: &output, limits };
    let (end, took) = run(&job)?;
    let text = std::fs::read_to_string(&output).map_err(|error| error.to_string())?;
    match end {
        End::Code(0) => Ok((text.trim().to_owned(), took.as_secs_f64())),
        End::Late => Ok((LATE.to_owned(), took.as_secs_f64())),
        End::Code(_) | End::Killed => Err(format!("z3 did not end well: {}", text.lines().next().unwrap_or_default())),
    }
}

/// The result of a harness from the answers to its questions.
fn conclude(harness: &Harness, asked: &[Asked], answers: &[String], seconds: f64) -> HarnessResult {
    let mut result = unproven(harness, ENGINE, Verdict::Proved, String::new());
    (result.reason, result.seconds, result.bound) = (None, seconds, String::new());
    "z3, over the real numbers".clone_into(&mut result.solver);
    let judge = |kind: Kind, name: &str| {
        let of = |reach: bool| {
            let here = |(one, _): &(&Asked, &String)| one.kind == kind && one.name == name && one.reach == reach;
            asked.iter().zip(answers).find(here).map_or("", |(_, answer)| answer)
        };
        match (of(true), of(false)) {
            ("sat", "unsat") => Verdict::Proved,
            ("unsat", _) => Verdict::Vacuous,
            ("sat", "sat") => Verdict::Failed,
            (LATE, _) | (_, LATE) => Verdict::Timeout,
            // Nothing was asked, or it was not answered.
            _ => Verdict::Error,
        }
    };
    for claim in &mut result.claims {
        claim.verdict = judge(Kind::Claim, &claim.name);
    }
    for cover in &mut result.covers {
        let here = |(one, _): &(&Asked, &String)| one.kind == Kind::Cover && one.name == cover.name;
        cover.hit = asked.iter().zip(answers).find(here).is_some_and(|(_, answer)| answer == "sat");
    }
    let lemmas = asked.iter().filter(|one| one.kind == Kind::Lemma && one.reach);
    let wrong: Vec<_> = lemmas.filter(|one| judge(Kind::Lemma, &one.name) != Verdict::Proved).collect();
    // What rests on a lemma that does not hold is not proved.
    if let Some(lemma) = wrong.first() {
        let verdict = judge(Kind::Lemma, &lemma.name);
        result.claims.iter_mut().for_each(|claim| claim.verdict = claim.verdict.max(verdict));
        result.reason = Some(format!("lemma {}", lemma.name));
    }
    result.verdict = result.claims.iter().map(|claim| claim.verdict).max().unwrap_or(Verdict::Vacuous);
    if let Some(cover) = result.covers.iter().find(|cover| !cover.hit && result.verdict == Verdict::Proved) {
        result.reason = Some(format!("cover points that are not reached: {}", cover.name));
        result.verdict = Verdict::Vacuous;
    }
    if result.verdict != Verdict::Proved && result.reason.is_none() {
        let open = result.claims.iter().filter(|claim| claim.verdict != Verdict::Proved);
        result.reason =
            Some(format!("claims: {}", open.map(|claim| claim.name.as_str()).collect::<Vec<_>>().join(", ")));
    }
    result
}
