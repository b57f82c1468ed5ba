//! The co-simulation unit, as its users get it: packed, and run in FMPy beside the oracle.

use std::path::Path;
use std::process::Command;

use atc_tests::device;

use super::side::run;
use super::wheel::{environment, libraries};

#[test]
fn the_unit_does_in_fmpy_what_the_oracle_does() {
    let oracle = device::oracle();
    let target = Path::new(&oracle).parent().and_then(Path::parent).expect("in target/debug").to_owned();
    let bin = match environment(&target) {
        Ok(bin) => bin,
        Err(why) => {
            eprintln!("NOT RUN: nothing is known of the co-simulation unit: {why}");
            return;
        }
    };
    libraries(&target).unwrap_or_else(|why| panic!("{why}"));
    let fmi = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fmi");
    let packer = target.join("debug/fmu");
    let asked = |command: &mut Command| run(command).unwrap_or_else(|why| panic!("{why}"));
    let python = |script: &str| {
        let mut command = Command::new(bin.join("python"));
        command.arg("-B").arg(fmi.join(script));
        command
    };
    let said = asked(python("tests/test_fmu.py").env("ATC_ORACLE", oracle).env("ATC_FMU", &packer));
    assert!(said.contains("16 refused configurations") && said.contains("cycles without a difference"), "{said}");
    let folder = tempfile::tempdir().expect("a folder");
    let (config, unit) = (folder.path().join("config.json"), folder.path().join("onboard.fmu"));
    std::fs::write(&config, "{}").expect("a file");
    asked(Command::new(&packer).arg("--config").arg(&config).arg("-o").arg(&unit));
    let said = asked(python("examples/onboard.py").arg(&unit));
    assert!(said.contains(" 0.30 s  displayed 45    permitted 45    brake release\n"), "{said}");
    assert!(said.contains(" 6.07 s  displayed none  permitted none  brake emergency\n"), "{said}");
}
