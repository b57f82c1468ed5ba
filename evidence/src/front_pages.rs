//! The front pages: each crate's says what it uses, what uses it and where to begin, and the tables of theorems have every theorem.
//! This holds them against the manifests and the harnesses.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The heading of that part.
const HEADING: &str = "# In the house";

/// What a crate uses, and what its front page says.
struct Page {
    uses: BTreeSet<String>,
    text: String,
}

/// The crates of the workspace, by name.
fn pages() -> BTreeMap<String, Page> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("in the checkout");
    let read =
        |path: &Path| std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let manifest = |path: &Path| read(path).parse::<toml::Table>().expect("a manifest");
    let members = manifest(&root.join("Cargo.toml"))["workspace"]["members"].clone();
    let page = |folder: &toml::Value| {
        let folder = root.join(folder.as_str().expect("a folder"));
        let manifest = manifest(&folder.join("Cargo.toml"));
        let used = manifest.get("dependencies").and_then(toml::Value::as_table).into_iter().flat_map(toml::Table::keys);
        let uses = used.filter(|name| name.starts_with("atc-")).cloned().collect();
        let source = read(&folder.join("src/lib.rs"));
        let lines = source.lines().filter_map(|line| line.strip_prefix("//!")).map(str::trim);
        let text = lines.skip_while(|line| *line != HEADING).skip(1).collect::<Vec<_>>().join(" ");
        (manifest["package"]["name"].as_str().expect("a name").to_owned(), Page { uses, text })
    };
    members.as_array().expect("members").iter().map(page).collect()
}

/// The crates that a sentence names.
fn named(sentence: &str) -> BTreeSet<String> {
    sentence.split('`').skip(1).step_by(2).filter(|name| name.starts_with("atc-")).map(ToOwned::to_owned).collect()
}

#[test]
fn front_pages_say_what_the_manifests_say() {
    let pages = pages();
    assert!(pages.len() > 20, "{}", pages.len());
    for (name, page) in &pages {
        let users = pages.iter().filter(|(_, other)| other.uses.contains(name)).map(|(other, _)| other.clone());
        let (uses, rest) = page.text.split_once(" Used by ").unwrap_or_else(|| panic!("{name}: no part {HEADING:?}"));
        let (used_by, begin) = rest.split_once(" Begin with ").unwrap_or_else(|| panic!("{name}: where to begin?"));
        assert_eq!(named(uses), page.uses, "{name}: what it uses");
        assert_eq!(named(used_by), users.collect(), "{name}: what uses it");
        assert!(begin.contains('`'), "{name}: where to begin?");
    }
}

/// The theorems that the first column of a table names, such as `T-ACC-1…8`, `T-TRK` (the only one), `T-LAY-2, 3`.
fn tabled(row: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut family = String::new();
    // Beside a machine's name they stand in brackets.
    let row = row.split_once('(').map_or(row, |(_, names)| names);
    for part in row.split(['(', ')', ',', ' ']).filter(|part| !part.is_empty()) {
        let name = part.trim_end_matches(|letter: char| letter.is_ascii_digit() || letter == '…').trim_end_matches('-');
        let is_name = name.len() > 2 && name.chars().all(|letter| letter.is_ascii_uppercase() || letter == '-');
        if is_name {
            name.clone_into(&mut family);
        } else if !name.is_empty() || family.is_empty() {
            continue;
        }
        let numbers = part.trim_start_matches(|letter: char| !letter.is_ascii_digit());
        let (first, last) = numbers.split_once('…').unwrap_or((numbers, numbers));
        match (first.parse::<u32>(), last.parse::<u32>()) {
            (Ok(first), Ok(last)) => found.extend((first..=last).map(|number| format!("{family}-{number}"))),
            _ if is_name => drop(found.insert(format!("{family}-*"))),
            _ => {}
        }
    }
    found
}

#[test]
fn the_tables_of_theorems_have_every_theorem() {
    has_every_theorem("README.md", "| machine |");
    has_every_theorem("proofs/README.md", "| theorem |");
}

/// The table in `file` that begins with `head` names every theorem, and no other.
fn has_every_theorem(file: &str, head: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("in the checkout");
    let readme = std::fs::read_to_string(root.join(file)).expect("there");
    let table = readme.lines().skip_while(|line| !line.starts_with(head)).skip(2);
    let rows = table.take_while(|line| line.starts_with('|'));
    let named: BTreeSet<_> = rows.flat_map(|row| tabled(row.split('|').nth(1).expect("a column"))).collect();
    let theorems: BTreeSet<_> =
        crate::sources::proofs::catalogue().into_iter().map(|harness| harness.theorem).collect();
    let family = |theorem: &str| {
        let beginning = theorem.trim_end_matches(|letter: char| letter.is_ascii_digit() || letter == '*');
        format!("{}-*", beginning.trim_end_matches('-'))
    };
    let missing: Vec<_> =
        theorems.iter().filter(|one| !named.contains(*one) && !named.contains(&family(one))).collect();
    assert!(missing.is_empty(), "the table of {file} does not name {missing:?}; it names {named:?}");
    // A range may pass over a number that was given up; it does not go on beyond the last one.
    let beyond = |name: &&String| {
        let number = |one: &str| one.rsplit('-').next().and_then(|number| number.parse::<u32>().ok());
        let last = theorems.iter().filter(|one| family(one) == family(name)).filter_map(|one| number(one)).max();
        last < number(name).or(Some(0))
    };
    let beyond: Vec<_> = named.iter().filter(beyond).collect();
    assert!(beyond.is_empty(), "the table of {file} names {beyond:?}, and there is no such theorem");
}
