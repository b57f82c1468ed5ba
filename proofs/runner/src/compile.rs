//! From harness to C: rustc → wasm-ld → wasm2c.

use crate::loops::one_way_back;
use crate::process::{End, Job, Limits, errors_of, run};
use crate::regions::apart;
use crate::tools::Tools;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The options of every compilation. Optimised, because that is what is proven; with overflow checks, because an
/// overflow must be a trap; one unit with everything inlined, because CBMC likes locals better than memory.
pub const RUSTC: [&str; 9] = [
    "--edition=2024",
    "--target=wasm32-unknown-unknown",
    "-Copt-level=3",
    "-Cpanic=abort",
    "-Coverflow-checks=on",
    "-Ccodegen-units=1",
    "-Cllvm-args=-inline-threshold=1000000",
    "-Cllvm-args=-unroll-threshold=1000000",
    "-Cllvm-args=-jump-threading-threshold=0",
];

/// The kernel and its arithmetic are only linked into the harnesses, which are optimised as a whole: machine code of its own would be thrown away.
const KERNEL: [&str; 2] = ["--crate-type=rlib", "-Clinker-plugin-lto"];

/// Bytes of the stack in linear memory where it is not known what is needed. A harness that needs more traps out of bounds.
const STACK: u32 = 4096;

const LINK: [&str; 7] = [
    "--no-entry",
    "--gc-sections",
    "--stack-first",
    "--initial-memory=65536",
    "--import-undefined",
    "--strip-debug",
    "--export=__data_end",
];

const DRIVER: &str = include_str!("../../cbmc/driver.c");

const LIMITS: Limits = Limits { cpu: Duration::from_mins(4), memory_kib: 4 << 20 };

/// The harnesses, compiled: a static library from which one is linked at a time.
#[derive(Clone, Debug)]
pub struct Compiled {
    library: PathBuf,
    folder: PathBuf,
}

/// Which kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// As its sources are, and the harnesses as large as they say.
    AsItIs,
    /// A wrong one, and the harnesses smaller (what a small one rejects, a large one does) or whole.
    Wrong {
        /// As large as they say.
        whole: bool,
    },
    /// With wrong ones in it, of which one can be selected at run time.
    WithMutants {
        /// As large as they say.
        whole: bool,
    },
}

/// Copies the sources of kernel and harnesses into `sources`, and nothing else is there then.
///
/// # Errors
/// A file cannot be read or written.
pub fn copy(root: &Path, sources: &Path) -> Result<(), String> {
    if sources.exists() {
        std::fs::remove_dir_all(sources).map_err(|error| format!("{}: {error}", sources.display()))?;
    }
    let folders = ["arithmetic/src", "kernel/src", "proofs/src"];
    folders.iter().try_for_each(|folder| copy_all(&root.join(folder), &sources.join(folder)))
}

fn copy_all(from: &Path, to: &Path) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", from.display());
    std::fs::create_dir_all(to).map_err(failed)?;
    for entry in std::fs::read_dir(from).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy_all(&entry.path(), &target)?;
        } else {
            std::fs::copy(entry.path(), &target).map_err(failed)?;
        }
    }
    Ok(())
}

/// Compiles the kernel with its arithmetic, and the harnesses `only` (all of them if none is named), whose sources are below `sources`
/// (`arithmetic/src`, `kernel/src`, `proofs/src`), into `folder`.
///
/// # Errors
/// What the compiler said.
pub fn compile(
    tools: &Tools,
    sources: &Path,
    folder: &Path,
    aspects: usize,
    only: &[String],
    mutants: Kernel,
) -> Result<Compiled, String> {
    fresh(folder)?;
    let arithmetic = folder.join("libatc_arithmetic.rlib");
    let kernel = folder.join("libatc_kernel.rlib");
    let library = folder.join("libatc_proofs.a");
    let with_arithmetic = format!("--extern=atc_arithmetic={}", arithmetic.display());
    let linked = KERNEL.map(ToOwned::to_owned).to_vec();
    rustc(tools, &sources.join("arithmetic/src/lib.rs"), &arithmetic, &linked, aspects)?;
    let linked = [linked, vec![with_arithmetic.clone()]].concat();
    rustc(tools, &sources.join("kernel/src/lib.rs"), &kernel, &linked, aspects)?;
    let mut options = vec![
        "--crate-type=staticlib".to_owned(),
        "-Clto=fat".to_owned(),
        "--cfg=engine=\"cbmc\"".to_owned(),
        with_arithmetic,
        format!("--extern=atc_kernel={}", kernel.display()),
        // Where the kernel's own dependency is looked for.
        format!("-Ldependency={}", folder.display()),
    ];
    if matches!(mutants, Kernel::Wrong { whole: false } | Kernel::WithMutants { whole: false }) {
        options.push("--cfg=small".to_owned());
    }
    if matches!(mutants, Kernel::WithMutants { .. }) {
        options.push("--cfg=mutants".to_owned());
    }
    if !only.is_empty() {
        // What only the others use is not used.
        options.extend(["--cfg=chosen", "--cap-lints=allow"].map(ToOwned::to_owned));
        options.extend(only.iter().map(|name| format!("--cfg={name}")));
    }
    rustc(tools, &sources.join("proofs/src/lib.rs"), &library, &options, aspects)?;
    Ok(Compiled { library, folder: folder.to_path_buf() })
}

/// Compiles one file without dependencies into a static library (the self-test).
///
/// # Errors
/// What the compiler said.
pub fn compile_one(tools: &Tools, source: &Path, folder: &Path) -> Result<Compiled, String> {
    fresh(folder)?;
    let library = folder.join("libselftest.a");
    rustc(tools, source, &library, &["--crate-type=staticlib".to_owned(), "-Clto=fat".to_owned()], 1)?;
    Ok(Compiled { library, folder: folder.to_path_buf() })
}

impl Compiled {
    /// Links the harness `name` alone and turns it into C. Its stack has `stack` bytes, or as many as its frames need. Returns the folder with
    /// `harness.c`, `harness.h`, which says how much memory there is, and `original.c`, which is not rewritten.
    ///
    /// # Errors
    /// What the linker or wasm2c said.
    pub fn to_c(&self, tools: &Tools, name: &str, stack: Option<u32>) -> Result<PathBuf, String> {
        let folder = self.folder.join(name);
        fresh(&folder)?;
        let mut text = self.linked(tools, name, &folder, stack.unwrap_or(STACK))?;
        if let Some(needed) = frames(&text).filter(|_| stack.is_none()) {
            text = self.linked(tools, name, &folder, needed)?;
        }
        let memory = memory(&text)?;
        let header = folder.join("harness.h");
        let declared = std::fs::read_to_string(&header).map_err(|error| format!("{}: {error}", header.display()))?;
        let (code, data) = data_apart(&without_accessors(&text)?, memory)?;
        write(&header, &with_memory(declared, memory, &data))?;
        write(&folder.join("original.c"), &code)?;
        write(&folder.join("harness.c"), &apart(&one_way_back(&code)?)?)?;
        write(&folder.join("driver.c"), DRIVER)?;
        Ok(folder)
    }

    /// The C of the harness `name` with so many bytes of stack, as wasm2c writes it.
    fn linked(&self, tools: &Tools, name: &str, folder: &Path, stack: u32) -> Result<String, String> {
        let (wasm, source) = (folder.join("harness.wasm"), folder.join("harness.c"));
        let mut link: Vec<String> = LINK.iter().map(ToString::to_string).collect();
        link.extend([format!("--export={name}"), format!("-zstack-size={stack}"), "-o".to_owned()]);
        link.extend([wasm.display().to_string(), self.library.display().to_string()]);
        tool(tools, "wasm-ld", &link, &[], folder)?;
        let convert =
            ["-n", "h", &wasm.display().to_string(), "-o", &source.display().to_string()].map(ToOwned::to_owned);
        tool(tools, "wasm2c", &convert, &[], folder)?;
        std::fs::read_to_string(&source).map_err(|error| format!("{}: {error}", source.display()))
    }
}

/// Bytes of stack for the frames of all functions: none calls itself. `None` if a frame is taken in a way that is not known here.
fn frames(text: &str) -> Option<u32> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let taken = |place: usize| {
        let [_, size, minus, ..] = lines.get(place..)? else { return None };
        let size = size.strip_prefix("var_i1 = ")?.strip_suffix("u;")?;
        (*minus == "var_i0 -= var_i1;").then(|| size.parse::<u32>().ok())?
    };
    let read = lines.iter().enumerate().filter(|(_, line)| line.contains("= instance->w2c_0x5F_stack_pointer;"));
    let needed = read.map(|(place, _)| taken(place)).sum::<Option<u32>>()?;
    // Nothing is at address 0: that would be nowhere.
    Some((needed + 1).next_multiple_of(16))
}

/// Bytes of linear memory that are in use, stack and data, in whole words. The linker puts the stack first and says where the data end.
fn memory(text: &str) -> Result<u32, String> {
    let end =
        text.lines().find_map(|line| line.trim().strip_prefix("instance->w2c_0x5F_data_end = ")?.strip_suffix("u;"));
    let end = end.and_then(|end| end.parse::<u32>().ok());
    end.map(|end| end.next_multiple_of(4)).ok_or_else(|| "the C does not say where its data end".to_owned())
}

/// The header with the size of linear memory in bytes, and the words that are in it at the start: the first ones, and 0 from there on.
fn with_memory(header: String, bytes: u32, data: &[u32]) -> String {
    let words: Vec<String> = data.iter().map(|word| format!("{word}u")).collect();
    header + &format!("\n#define MEMORY {bytes}\n#define DATA {{{}}}\n", words.join(","))
}

/// The C without its constant data, and the words of linear memory with them in their places. Loaded when the program begins, byte by byte, they
/// took CBMC half of its time.
///
/// # Errors
/// Text that wasm2c 1.0.36 does not write.
fn data_apart(text: &str, memory: u32) -> Result<(String, Vec<u32>), String> {
    const LOADS: &str = "LOAD_DATA(instance->w2c_memory, ";
    let strange = |line: &str| format!("data that wasm2c 1.0.36 does not write: `{}`", line.trim());
    let (mut code, mut bytes) = (String::with_capacity(text.len()), vec![0_u8; memory as usize]);
    let mut segments: BTreeMap<&str, Vec<u8>> = BTreeMap::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some(rest) = line.strip_prefix("static const u8 data_segment_data_") {
            let name = rest.strip_suffix("[] = {").ok_or_else(|| strange(line))?;
            let mut segment = Vec::new();
            for line in lines.by_ref().take_while(|line| *line != "};") {
                for byte in line.split(',').map(str::trim).filter(|byte| !byte.is_empty()) {
                    let byte = byte.strip_prefix("0x").and_then(|byte| u8::from_str_radix(byte, 16).ok());
                    segment.push(byte.ok_or_else(|| strange(line))?);
                }
            }
            segments.insert(name, segment);
        } else if let Some(rest) = line.trim().strip_prefix(LOADS) {
            let mut parts = rest.split(", ");
            let mut next = || parts.next().ok_or_else(|| strange(line));
            let to = next()?.strip_suffix('u').and_then(|to| to.parse::<usize>().ok());
            let segment = next()?.strip_prefix("data_segment_data_").and_then(|name| segments.get(name));
            let size = next()?.strip_suffix(");").and_then(|size| size.parse::<usize>().ok());
            let (Some(to), Some(segment), Some(size)) = (to, segment, size) else { return Err(strange(line)) };
            let place = bytes.get_mut(to..to.saturating_add(size)).filter(|_| segment.len() == size);
            place.ok_or_else(|| strange(line))?.copy_from_slice(segment);
        } else {
            code.push_str(line);
            code.push('\n');
        }
    }
    let words = bytes.chunks(4).map(|word| word.iter().rev().fold(0, |sum, byte| sum << 8 | u32::from(*byte)));
    Ok((code, words.collect()))
}

/// Puts C that was written by hand where that of a harness would be, with so many bytes of memory.
pub(crate) fn write_c(folder: &Path, header: &str, memory: u32) -> Result<(), String> {
    fresh(folder)?;
    write(&folder.join("harness.h"), &with_memory(header.to_owned(), memory, &[0]))?;
    write(&folder.join("harness.c"), "")?;
    write(&folder.join("driver.c"), DRIVER)
}

/// wasm2c's own accessors of linear memory go through memcpy, which CBMC does not look into: the driver has typed ones.
fn without_accessors(text: &str) -> Result<String, String> {
    let mut kept = String::with_capacity(text.len());
    let mut in_macro = false;
    let mut removed = 0;
    for line in text.lines() {
        let is_accessor = line.starts_with("DEFINE_LOAD(") || line.starts_with("DEFINE_STORE(");
        let starts_macro = line.starts_with("#define LOAD_DATA");
        removed += usize::from(is_accessor || starts_macro);
        if !is_accessor && !starts_macro && !in_macro {
            kept.push_str(line);
            kept.push('\n');
        }
        in_macro = (in_macro || starts_macro) && line.ends_with('\\');
    }
    // 23 accessors and the macro, of wasm2c 1.0.36; other versions must be looked at before they are believed.
    if removed >= 20 { Ok(kept) } else { Err(format!("only {removed} accessors in the C of this wasm2c")) }
}

fn fresh(folder: &Path) -> Result<(), String> {
    let failed = |error| format!("{}: {error}", folder.display());
    if folder.exists() {
        std::fs::remove_dir_all(folder).map_err(failed)?;
    }
    std::fs::create_dir_all(folder).map_err(failed)
}

pub(crate) fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// Compiles `source` into `output` (`libNAME.rlib` or `libNAME.a`).
fn rustc(tools: &Tools, source: &Path, output: &Path, options: &[String], aspects: usize) -> Result<(), String> {
    let folder = output.parent().unwrap_or(output);
    let name = output.file_stem().map(|stem| stem.to_string_lossy().replacen("lib", "", 1)).unwrap_or_default();
    let mut arguments: Vec<String> = RUSTC.iter().map(ToString::to_string).collect();
    arguments.push(format!("--crate-name={name}"));
    arguments.extend(options.iter().cloned());
    arguments.extend(["-o".to_owned(), output.display().to_string(), source.display().to_string()]);
    tool(tools, "rustc", &arguments, &[("ATC_ASPECTS", aspects.to_string())], folder)
}

fn tool(
    tools: &Tools,
    name: &str,
    arguments: &[String],
    variables: &[(&str, String)],
    folder: &Path,
) -> Result<(), String> {
    let output = folder.join(format!("{name}.out"));
    let program = tools.path(name);
    let job = Job { program: &program, arguments, variables, folder, output: &output, limits: LIMITS };
    match run(&job)?.0 {
        End::Code(0) => Ok(()),
        end => {
            let said = std::fs::read_to_string(errors_of(&output)).unwrap_or_default();
            let first: Vec<_> = said.lines().filter(|line| !line.is_empty()).take(6).collect();
            Err(format!("{name}: {end:?}: {}", first.join(" / ")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::data_apart;

    const ROWS: &str = "static const u8 data_segment_data_w2c_h_d0[] = {\n  0x01, 0x02, 0x03, \n  0xFF, 0x05, \n};\n";

    fn loads(of: &str) -> String {
        format!("void load(void) {{\n  LOAD_DATA(instance->w2c_memory, {of});\n}}\n")
    }

    #[test]
    fn data_are_where_they_were() {
        let text = ROWS.to_owned() + &loads("6u, data_segment_data_w2c_h_d0, 5");
        let wanted = vec![0, 0x0201_0000, 0x0005_FF03];
        assert_eq!(data_apart(&text, 12), Ok(("void load(void) {\n}\n".to_owned(), wanted)));
        assert_eq!(data_apart("void f(void) {\n}\n", 4), Ok(("void f(void) {\n}\n".to_owned(), vec![0])));
    }

    #[test]
    fn data_of_another_kind_are_an_error() {
        for (of, memory) in [
            ("6u, data_segment_data_w2c_h_d0, 5", 8),
            ("6u, data_segment_data_w2c_h_d0, 4", 12),
            ("6u, data_segment_data_w2c_h_d1, 5", 12),
            ("var_i0, data_segment_data_w2c_h_d0, 5", 12),
        ] {
            assert!(data_apart(&(ROWS.to_owned() + &loads(of)), memory).is_err(), "{of}");
        }
        assert!(data_apart(&ROWS.replace("0xFF", "-1"), 12).is_err());
    }
}
