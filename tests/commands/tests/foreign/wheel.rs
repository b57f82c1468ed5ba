//! The Python module, as its users get it: built into a wheel, installed, and asked.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use atc_tests::device;

use super::side::{self, run};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../python")
}

/// What building and testing take besides Python itself. FMPy is for the unit of `fmi/`.
const PACKAGES: [&str; 5] =
    ["maturin>=1.9,<2", "wheel>=0.45,<1", "numpy>=1.24,<3", "mypy>=1.18,<3", "fmpy>=0.3.22,<0.4"];

/// The programs of a Python of our own with these packages, under `target`; or why there are none. It is made once, for all tests.
pub fn environment(target: &Path) -> Result<PathBuf, String> {
    static MADE: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    MADE.get_or_init(|| made(target)).clone()
}

fn made(target: &Path) -> Result<PathBuf, String> {
    let place = target.join("python/environment");
    let (whole, packages) = (place.join("whole"), PACKAGES.join("\n"));
    if fs::read_to_string(&whole).is_ok_and(|made| made == packages) {
        return Ok(place.join("bin"));
    }
    // One that was begun and not ended, or is for other packages, is no good.
    let _ = fs::remove_dir_all(&place);
    run(Command::new("python3").args(["-m", "venv"]).arg(&place))?;
    run(Command::new(place.join("bin/pip")).args(["install", "--quiet"]).args(PACKAGES))?;
    fs::write(&whole, packages).map_err(|error| error.to_string())?;
    Ok(place.join("bin"))
}

/// Builds every library, and the program `fmu`, as all tests are built: so nothing that they use is built once more with other features.
pub fn libraries(target: &Path) -> Result<(), String> {
    let mut build = Command::new(env!("CARGO"));
    build.args(["build", "--quiet", "--locked", "--workspace", "--lib", "--bin", "fmu", "--test", "contracts"]);
    run(build.env("CARGO_TARGET_DIR", target).current_dir(folder())).map(drop)
}

/// The wheel, packed as `maturin build` does it, in a folder of its own: tests run beside each other.
pub fn packed(target: &Path, bin: &Path, place: &Path) -> Result<PathBuf, String> {
    let library = target.join("debug/lib_atc.so");
    libraries(target)?;
    let (unpacked, wheels) = (place.join("unpacked"), place.join("wheels"));
    let said = |error: std::io::Error| error.to_string();
    for place in [&unpacked, &wheels] {
        let _ = fs::remove_dir_all(place);
        fs::create_dir_all(place.join("atc")).map_err(said)?;
    }
    fs::remove_dir(wheels.join("atc")).map_err(said)?;
    for entry in fs::read_dir(folder().join("atc")).map_err(said)? {
        let path = entry.map_err(said)?.path();
        if let Some(name) = path.file_name().filter(|_| path.is_file()) {
            fs::copy(&path, unpacked.join("atc").join(name)).map_err(said)?;
        }
    }
    fs::copy(library, unpacked.join("atc/_atc.abi3.so")).map_err(said)?;
    let mut about = Command::new(bin.join("maturin"));
    about.args(["pep517", "write-dist-info", "--metadata-directory"]).arg(&unpacked);
    run(about.arg("--interpreter").arg(bin.join("python")).current_dir(folder()))?;
    run(Command::new(bin.join("wheel")).arg("pack").arg(&unpacked).arg("--dest-dir").arg(&wheels))?;
    let mut made = fs::read_dir(&wheels).map_err(said)?;
    Ok(made.next().ok_or("no wheel")?.map_err(said)?.path())
}

#[test]
fn the_wheel_holds_what_its_page_promises() {
    let oracle = device::oracle();
    let target = Path::new(&oracle).parent().and_then(Path::parent).expect("in target/debug").to_owned();
    let bin = match environment(&target) {
        Ok(bin) => bin,
        Err(why) => {
            eprintln!("NOT RUN: nothing is known of the Python module: {why}");
            return;
        }
    };
    let python = bin.join("python");
    let wheel = packed(&target, &bin, &target.join("python")).unwrap_or_else(|why| panic!("{why}"));
    let install = ["install", "--quiet", "--no-index", "--no-deps", "--force-reinstall"];
    run(Command::new(bin.join("pip")).args(install).arg(&wheel)).unwrap_or_else(|why| panic!("{why}"));
    let asked = |script: &Path| run(Command::new(&python).arg("-B").arg(script)).unwrap_or_else(|why| panic!("{why}"));
    asked(&folder().join("tests/test_atc.py"));
    let said = asked(&folder().join("examples/aspect.py"));
    assert!(said.contains("  250 ms  heard [45]  displayed 45\n 1650 ms  heard []  displayed None\n"), "{said}");
    assert!(asked(&folder().join("examples/columns.py")).contains(" 0 per mille: [  0.   72. "));
    // The stubs say what is there.
    let stubs = bin.join("stubtest");
    run(Command::new(stubs).args(["atc", "--ignore-disjoint-bases"]).current_dir(&bin))
        .unwrap_or_else(|why| panic!("{why}"));
    sessions(&python);
}

/// Every session of the oracle's examples has the same replies from the module.
fn sessions(python: &Path) {
    let pass_on = "import sys, atc._atc\nsays = atc._atc.Conversation()\nfor line in open(sys.argv[1]):\n    \
                   print(says.answer(line.rstrip('\\n')))";
    for path in side::examples() {
        let ours =
            run(Command::new(python).args(["-B", "-c", pass_on]).arg(&path)).unwrap_or_else(|why| panic!("{why}"));
        let theirs = run(side::oracle().stdin(fs::File::open(&path).expect("a session"))).expect("the oracle answers");
        assert!(ours == theirs, "{}: the module says something else", path.display());
    }
}
