//! Every crate's front page says what it uses, what uses it and where to begin; this holds it against the manifests.

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
