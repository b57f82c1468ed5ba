//! `include/atc.h` is what cbindgen makes of `src/`, and compilers of C and C++ take it without a word.

use std::fs;
use std::path::{Path, PathBuf};

use crate::tools::{self, Scratch};

/// In this order the header has them.
const SOURCES: [&str; 11] = [
    "memory.rs",
    "status.rs",
    "aspect.rs",
    "supervision.rs",
    "block.rs",
    "pattern.rs",
    "permitted.rs",
    "telegram.rs",
    "train.rs",
    "interlocking/forms.rs",
    "border.rs",
];

const ABOUT: &str = "/*
 * The verified train control kernel for C. README.md beside the library's source has the rules of this border.
 * Made from the source by cbindgen; a test holds the two against each other. Not to be edited.
 */";

fn made() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).expect("cbindgen.toml can be read");
    let mut builder = cbindgen::Builder::new().with_config(config).with_header(ABOUT);
    for source in SOURCES {
        builder = builder.with_src(folder.join("src").join(source));
    }
    let mut text = Vec::new();
    builder.generate().expect("the source can be read").write(&mut text);
    // Rust's word for it, and letters that not every compiler of C reads.
    let text = String::from_utf8(text).expect("UTF-8").replace("# Safety", "Of the caller:").replace('²', "2");
    named(&text)
}

/// A structure of both sizes has a name of cbindgen's for each size, and another name beside it: it gets that one alone.
fn named(text: &str) -> String {
    let (mut kept, mut names) = (String::new(), Vec::new());
    for paragraph in text.split_inclusive("\n\n") {
        let last = paragraph.trim_end().lines().last().unwrap_or_default();
        let alias = last.strip_prefix("typedef struct ").and_then(|alias| alias.strip_suffix(';')?.split_once(' '));
        match alias {
            Some((made, name)) if made.contains("_of_") => names.push((made.to_owned(), name.to_owned())),
            _ => kept.push_str(paragraph),
        }
    }
    // The longer name first: one may be the beginning of another.
    names.sort_by_key(|(made, _)| std::cmp::Reverse(made.len()));
    names.iter().fold(kept, |text, (made, name)| text.replace(made, name))
}

fn committed() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("include/atc.h")
}

#[test]
fn the_header_is_up_to_date() {
    let made = made();
    assert!(made.is_ascii(), "only ASCII in a header: {:?}", made.chars().find(|letter| !letter.is_ascii()));
    if std::env::var_os("ATC_WRITE_HEADER").is_some() {
        fs::write(committed(), &made).expect("the header can be written");
    }
    let is = fs::read_to_string(committed()).unwrap_or_default();
    let differs = is.lines().zip(made.lines()).position(|(is, made)| is != made);
    assert!(
        is == made,
        "include/atc.h is not what src/ makes of it, from line {} on; write it anew with ATC_WRITE_HEADER=1",
        differs.map_or(is.lines().count().min(made.lines().count()), |line| line) + 1
    );
}

/// The sizes in the header are those of the structures, so that a C program can set memory aside without asking.
#[test]
fn the_sizes_are_right() {
    use atc_c::{aspect, block, border, interlocking, permitted, supervision, telegram, train};
    let said = [
        (aspect::ATC_ASPECT_SIZE, aspect::ATC_ASPECT_ALIGN, border::atc_aspect_size(), border::atc_aspect_align()),
        (
            supervision::ATC_SUPERVISION_SIZE,
            supervision::ATC_SUPERVISION_ALIGN,
            border::atc_supervision_size(),
            border::atc_supervision_align(),
        ),
        (block::ATC_BLOCK_SIZE, block::ATC_BLOCK_ALIGN, border::atc_block_size(), border::atc_block_align()),
        (
            permitted::ATC_PERMITTED_SIZE,
            permitted::ATC_PERMITTED_ALIGN,
            border::atc_permitted_size(),
            border::atc_permitted_align(),
        ),
        (
            telegram::ATC_DEFRAMER_SIZE,
            telegram::ATC_DEFRAMER_ALIGN,
            border::atc_deframer_size(),
            border::atc_deframer_align(),
        ),
        (train::ATC_TRAIN_SIZE, train::ATC_TRAIN_ALIGN, border::atc_train_size(), border::atc_train_align()),
        (
            interlocking::ATC_INTERLOCKING_SIZE,
            interlocking::ATC_INTERLOCKING_ALIGN,
            border::atc_interlocking_size(),
            border::atc_interlocking_align(),
        ),
        (
            interlocking::ATC_LARGE_INTERLOCKING_SIZE,
            interlocking::ATC_LARGE_INTERLOCKING_ALIGN,
            border::atc_large_interlocking_size(),
            border::atc_large_interlocking_align(),
        ),
    ];
    for (size, align, true_size, true_align) in said {
        assert_eq!((size, align), (true_size, true_align));
    }
}

#[test]
fn c_and_cpp_compilers_take_it() {
    let scratch = Scratch::new();
    let source = scratch.file("only.c", "#include \"atc.h\"\n");
    for (compiler, language, standard) in [("gcc", "c", "-std=c99"), ("g++", "c++", "-std=c++11")] {
        let strict = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only", standard, "-x", language];
        let include = tools::include();
        let Some(output) = tools::run(compiler, strict.map(Into::into).into_iter().chain([include, source.clone()]))
        else {
            eprintln!("NOT RUN: no {compiler} here: nothing is known of the header in {language}");
            continue;
        };
        assert!(output.status.success(), "{compiler}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

/// Every status of the enumeration has its sentence, once.
#[test]
fn every_status_has_a_sentence() {
    let header = made();
    let (_, rest) = header.split_once("typedef enum atc_status {").expect("the enumeration is there");
    let (inside, _) = rest.split_once('}').expect("it ends");
    let numbers = inside.lines().filter_map(|line| line.split_once(" = ")?.1.trim_end_matches(',').parse().ok());
    let numbers: Vec<i32> = numbers.collect();
    let texts: Vec<i32> = atc_c::atc_status::ALL.iter().map(|(status, _)| *status as i32).collect();
    assert_eq!(numbers, texts);
    for number in -1..200 {
        let text = atc_c::atc_status::text(number);
        assert!(!text.is_empty() && text.to_bytes().is_ascii());
        assert_eq!(text == c"there is no status of this number", !numbers.contains(&number), "{number}");
    }
}
