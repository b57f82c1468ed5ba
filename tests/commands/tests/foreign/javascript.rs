//! The package for JavaScript, as its users get it: compiled to WebAssembly, installed by npm, and asked.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use atc_tests::device;

use super::side::{examples, oracle, run};

fn checkout() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The package, compiled here; or why it cannot be.
fn package(folder: &Path) -> Result<PathBuf, String> {
    let place = folder.join("package");
    run(Command::new(checkout().join("ci/wasm-package")).arg(&place).env("ATC_WASM", "quick"))?;
    Ok(place)
}

/// The TypeScript compiler, as npm brings it; or why there is none.
fn typescript(folder: &Path) -> Result<PathBuf, String> {
    let place = folder.join("tools");
    let compiler = place.join("node_modules/typescript/bin/tsc");
    if !compiler.is_file() {
        fs::create_dir_all(&place).map_err(|error| error.to_string())?;
        let install = ["install", "--no-audit", "--no-fund", "--prefix"];
        run(Command::new("npm").args(install).arg(&place).arg("typescript@5"))?;
    }
    Ok(compiler)
}

#[test]
fn the_package_holds_what_its_page_promises() {
    let target = Path::new(&device::oracle()).parent().and_then(Path::parent).expect("in target/debug").to_owned();
    let folder = target.join("javascript");
    if let Err(why) = run(Command::new("npm").arg("--version")) {
        eprintln!("NOT RUN: nothing is known of the package for JavaScript: {why}");
        return;
    }
    let package = match package(&folder) {
        Ok(package) => package,
        Err(why) if why.contains("no Rust with wasm32-unknown-unknown here") => {
            eprintln!("NOT RUN: nothing is known of the package for JavaScript: {why}");
            return;
        }
        Err(why) => panic!("{why}"),
    };
    // A project of a user.
    let user = folder.join("user");
    let _ = fs::remove_dir_all(&user);
    fs::create_dir_all(&user).expect("a folder");
    fs::write(user.join("package.json"), r#"{"name":"user","private":true,"type":"module"}"#).expect("a file");
    let asked = |command: &mut Command| run(command.current_dir(&user)).unwrap_or_else(|why| panic!("{why}"));
    asked(Command::new("npm").args(["install", "--offline", "--no-audit", "--no-fund"]).arg(&package));
    for (from, name) in [("tests", "atc.test.js"), ("examples", "aspect.js"), ("tests", "pass-on.js")] {
        fs::copy(checkout().join("wasm").join(from).join(name), user.join(name)).expect("a copy");
    }
    let said = asked(Command::new("node").args(["--test", "--test-reporter=tap", "atc.test.js"]));
    assert!(said.contains("# pass 6") && said.contains("# fail 0"), "{said}");
    let said = asked(Command::new("node").arg("aspect.js"));
    assert!(said.contains("  250 ms  heard [45]  displayed 45\n 1650 ms  heard []  displayed null\n"), "{said}");
    for session in examples() {
        let ours = asked(Command::new("node").arg("pass-on.js").arg(&session));
        let theirs = run(oracle().stdin(fs::File::open(&session).expect("a session"))).expect("the oracle answers");
        assert!(ours == theirs, "{}: the package says something else", session.display());
    }
    match typescript(&folder) {
        Ok(compiler) => {
            fs::copy(checkout().join("wasm/tests/types.ts"), user.join("types.ts")).expect("a copy");
            let options = ["--noEmit", "--strict", "--target", "es2022", "--module", "nodenext", "types.ts"];
            asked(Command::new("node").arg(compiler).args(options));
        }
        Err(why) => eprintln!("NOT RUN: nothing is known of the types for JavaScript: {why}"),
    }
}
