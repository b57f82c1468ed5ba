//! Requirements: the headings and MUST sentences of `spec/`, and where the code and the tests quote them.

use crate::error::{Fault, read};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A requirement as the specification has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Requirement {
    /// ACC-1, …
    pub id: String,
    /// The heading without the id.
    pub title: String,
    /// The sentence with MUST.
    pub sentence: String,
    /// `spec/aspect.md:12`.
    pub at: String,
    /// `spec/aspect.md#acc-1-operate`: how the code cites it.
    pub anchor: String,
}

/// A quotation of a requirement in a comment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Citation {
    /// `spec/aspect.md#acc-1-operate`.
    pub anchor: String,
    /// The quoted words.
    pub quote: String,
    /// `kernel/src/….rs:12`.
    pub at: String,
    /// It is about a test.
    pub is_test: bool,
}

/// All requirements of the Markdown files directly in `root/spec`.
///
/// # Errors
/// The folder cannot be read, an id is there twice, or a section has more than one paragraph with MUST.
pub fn specification(root: &Path) -> Result<Vec<Requirement>, Fault> {
    let mut all = Vec::new();
    for file in files(&root.join("spec"), "md")? {
        let name = format!("spec/{}", file.file_name().unwrap_or_default().to_string_lossy());
        all.extend(sections(&name, &read(&file)?)?);
    }
    let mut seen = BTreeMap::new();
    for one in &all {
        if let Some(first) = seen.insert(one.id.clone(), one.at.clone()) {
            return Err(Fault::new(&one.at, format!("requirement {} is there twice, first at {first}", one.id)));
        }
    }
    if all.is_empty() {
        return Err(Fault::new(
            &"spec",
            "no requirement found: a heading like \"## ACC-1 operate\" and a MUST sentence",
        ));
    }
    Ok(all)
}

/// The requirements of one file's text.
///
/// # Errors
/// A section whose heading has an id has more than one paragraph with MUST.
pub fn sections(name: &str, text: &str) -> Result<Vec<Requirement>, Fault> {
    let mut all: Vec<(Requirement, String)> = Vec::new();
    let mut inside = false;
    for (number, line) in text.lines().enumerate() {
        if line.starts_with('#') {
            let heading = line.trim_start_matches('#').trim();
            let (id, title) = heading.split_once(' ').unwrap_or((heading, ""));
            inside = line.starts_with("## ") && is_id(id);
            if inside {
                let anchor = format!("{name}#{}", anchor(heading));
                let (id, title) = (id.to_owned(), title.trim().to_owned());
                let at = format!("{name}:{}", number + 1);
                all.push((Requirement { id, title, sentence: String::new(), at, anchor }, String::new()));
            }
        } else if let (true, Some((_, body))) = (inside, all.last_mut()) {
            body.push_str(line);
            body.push('\n');
        }
    }
    let musts = |body: &str| body.split("\n\n").filter(|text| has_must(text)).map(words).collect::<Vec<_>>();
    all.into_iter()
        // Without the sentence it is a section about something else, a theorem of that name. That none is lost
        // so is for the ratchet.
        .map(|(one, body)| (one, musts(&body)))
        .filter(|(_, found)| !found.is_empty())
        .map(|(one, found)| match <[String; 1]>::try_from(found) {
            Ok([sentence]) => Ok(Requirement { sentence, ..one }),
            Err(found) => Err(Fault::new(
                &one.at,
                format!("{} has {} paragraphs with MUST; exactly one is right", one.id, found.len()),
            )),
        })
        .collect()
}

fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// All `//=` and `//#` quotations under these folders.
///
/// # Errors
/// A folder cannot be read. One that does not exist has none.
pub fn citations(root: &Path, folders: &[&str]) -> Result<Vec<Citation>, Fault> {
    let mut all = Vec::new();
    for folder in folders {
        for file in tree(&root.join(folder), "rs")? {
            let name = file.strip_prefix(root).unwrap_or(&file).to_string_lossy().replace('\\', "/");
            all.extend(quotations(&name, &read(&file)?));
        }
    }
    Ok(all)
}

fn quotations(name: &str, text: &str) -> Vec<Citation> {
    let mut all: Vec<Citation> = Vec::new();
    let mut open = false;
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if let Some(rest) = line.strip_prefix("//= ") {
            if let (true, Some(kind), Some(last)) = (open, rest.strip_prefix("type="), all.last_mut()) {
                last.is_test |= kind.trim() == "test";
            } else if rest.starts_with("spec/") {
                let (anchor, at) = (rest.trim().to_owned(), format!("{name}:{}", number + 1));
                let is_test = name.starts_with("tests/");
                all.push(Citation { anchor, quote: String::new(), at, is_test });
                open = true;
            }
        } else if let (true, Some(words), Some(last)) = (open, line.strip_prefix("//#"), all.last_mut()) {
            if !last.quote.is_empty() {
                last.quote.push(' ');
            }
            last.quote.push_str(words.trim());
        } else {
            open = false;
        }
    }
    all
}

/// What is wrong with a quotation: no such requirement, or not its words.
pub fn mismatch(citation: &Citation, requirements: &[Requirement]) -> Option<String> {
    let Some(requirement) = requirements.iter().find(|one| one.anchor == citation.anchor) else {
        return Some(format!("{} cites {}, which is not there", citation.at, citation.anchor));
    };
    let quote = words(&citation.quote);
    if quote.is_empty() || !requirement.sentence.contains(&quote) {
        return Some(format!("{} quotes {} with other words than the specification", citation.at, requirement.id));
    }
    None
}

/// `ACC-1`: capitals, a hyphen, digits.
fn is_id(word: &str) -> bool {
    word.split_once('-').is_some_and(|(letters, digits)| {
        !letters.is_empty()
            && !digits.is_empty()
            && letters.chars().all(|c| c.is_ascii_uppercase())
            && digits.chars().all(|c| c.is_ascii_digit())
    })
}

fn has_must(paragraph: &str) -> bool {
    paragraph.split(|c: char| !c.is_alphanumeric()).any(|word| word == "MUST")
}

fn anchor(heading: &str) -> String {
    let kept: String = heading.to_lowercase().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect();
    kept.replace(' ', "-")
}

fn files(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, Fault> {
    let entries = std::fs::read_dir(folder).map_err(|error| Fault::new(&folder.display(), error))?;
    let mut all: Vec<_> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .collect();
    all.sort();
    Ok(all)
}

/// The files with this extension in a folder and below; none if there is no such folder.
///
/// # Errors
/// A folder cannot be read.
pub fn tree(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, Fault> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let mut all = files(folder, extension)?;
    let entries = std::fs::read_dir(folder).map_err(|error| Fault::new(&folder.display(), error))?;
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| path.is_dir()) {
        if path.file_name().is_none_or(|name| name != "target") {
            all.extend(tree(&path, extension)?);
        }
    }
    all.sort();
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::{mismatch, quotations, sections};

    const TEXT: &str = "# Aspect\n\nWords.\n\n## Terms\n\nA term MUST not count.\n\n## ACC-1 operate, first\n\n\
                        An aspect MUST be\naccepted.\n\nWhy.\n\n### More\n\nIt MUST not count.\n";

    #[test]
    fn a_requirement_is_a_heading_and_a_sentence() {
        let all = sections("spec/a.md", TEXT).expect("good");
        assert_eq!(all.len(), 1);
        assert_eq!((all[0].id.as_str(), all[0].sentence.as_str()), ("ACC-1", "An aspect MUST be accepted."));
        assert_eq!((all[0].at.as_str(), all[0].anchor.as_str()), ("spec/a.md:9", "spec/a.md#acc-1-operate-first"));
    }

    #[test]
    fn a_section_without_the_sentence_is_none_and_two_are_refused() {
        assert_eq!(sections("a.md", "## ACC-1 x\n\nIt must.\n"), Ok(vec![]));
        let two = sections("a.md", "## ACC-1 x\n\nIt MUST.\n\nIt MUST.\n").expect_err("two");
        assert!(two.to_string().contains("a.md:1") && two.to_string().contains("2 paragraphs"), "{two}");
    }

    #[test]
    fn a_quotation_with_other_words_is_seen() {
        let spec = sections("spec/a.md", TEXT).expect("good");
        let code = "    //= spec/a.md#acc-1-operate-first\n    //# An aspect MUST be\n    //# accepted.\n    x();\n";
        let all = quotations("kernel/src/a.rs", code);
        assert_eq!(all.len(), 1);
        assert_eq!(mismatch(&all[0], &spec), None);
        let other = quotations("a.rs", &code.replace("be", "not be"));
        assert!(mismatch(&other[0], &spec).is_some());
        let nowhere = quotations("a.rs", &code.replace("acc-1", "acc-2"));
        assert!(mismatch(&nowhere[0], &spec).is_some());
    }
}
