//! SUMO's trains under its own signals, and under the kernel's devices: `simulation/sumo`, as its users run it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::thread;

use atc_tests::device;
use serde_json::Value;

use super::side::run;
use super::wheel::{environment, packed};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../simulation/sumo")
}

/// A folder below `target` with SUMO and its libraries; or why there is none.
fn simulator(bin: &Path, place: &Path) -> Result<PathBuf, String> {
    let said = |error: std::io::Error| error.to_string();
    run(Command::new(bin.join("python")).args(["-c", "import tomllib"])).map_err(|_| "Python is older than 3.11")?;
    let requirements = folder().join("requirements.txt");
    let wanted = fs::read_to_string(&requirements).map_err(said)?;
    let (packages, whole) = (place.join("packages"), place.join("whole"));
    if fs::read_to_string(&whole).is_ok_and(|made| made == wanted) {
        return Ok(packages);
    }
    // One that was begun and not ended, or is for other versions, is no good.
    let _ = fs::remove_dir_all(place);
    fs::create_dir_all(place).map_err(said)?;
    let mut install = Command::new(bin.join("pip"));
    install.args(["install", "--quiet", "--no-deps", "--require-hashes", "--only-binary", ":all:", "--target"]);
    run(install.arg(&packages).arg("-r").arg(&requirements))?;
    fs::write(&whole, wanted).map_err(said)?;
    Ok(packages)
}

/// What a run says, and whether it ended as one without an accident.
fn told(output: &Output) -> (Value, bool) {
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    let told = serde_json::from_str(said.trim()).unwrap_or_else(|why| panic!("{why}: {said}{errors}"));
    (told, output.status.success())
}

#[test]
fn opposing_trains_of_sumo_collide_but_not_under_our_devices() {
    let oracle = device::oracle();
    let target = Path::new(&oracle).parent().and_then(Path::parent).expect("in target/debug").to_owned();
    // What both devices count on is held against the layouts; the runs use the same files.
    run(Command::new(oracle).args(["line", "check"]).arg(folder().join("line.toml")))
        .unwrap_or_else(|why| panic!("{why}"));
    let place = target.join("python/sumo");
    let made = environment(&target).and_then(|bin| Ok((simulator(&bin, &place)?, bin)));
    let (packages, bin) = match made {
        Ok(made) => made,
        Err(why) => {
            eprintln!("NOT RUN: nothing is known of the trains of SUMO: {why}");
            return;
        }
    };
    let wheel = packed(&target, &bin, &place).unwrap_or_else(|why| panic!("{why}"));
    let own = tempfile::tempdir().expect("a folder");
    let mut install = Command::new(bin.join("pip"));
    install.args(["install", "--quiet", "--no-index", "--no-deps", "--target"]).arg(own.path()).arg(&wheel);
    run(&mut install).unwrap_or_else(|why| panic!("{why}"));
    let paths = std::env::join_paths([own.path(), &packages]).expect("paths");
    let started = |arguments: &[&str]| {
        let mut command = Command::new(bin.join("python"));
        command.arg("-B").arg(folder().join("run.py")).args(arguments).env("PYTHONPATH", &paths);
        told(&command.output().expect("Python runs"))
    };
    let (theirs, one_end, ours, mutant) = thread::scope(|scope| {
        let started = &started;
        let theirs = scope.spawn(|| started(&["--way", "signals", "--seconds", "240"]));
        let one_end = scope.spawn(|| started(&["--way", "one-end", "--seconds", "120"]));
        let ours = scope.spawn(|| started(&["--way", "ours", "--seconds", "360"]));
        let heedless = scope.spawn(|| started(&["--way", "ours", "--heedless", "--seconds", "360"]));
        let mutant = scope.spawn(|| started(&["--way", "ours", "--mutant", "--seconds", "200"]));
        let of = |run: thread::ScopedJoinHandle<(Value, bool)>| run.join().expect("a run");
        (of(theirs), of(one_end), [of(ours), of(heedless)], of(mutant))
    });
    let count = |(told, _): &(Value, bool), name: &str| {
        told[name].as_u64().unwrap_or_else(|| panic!("{name} is no number: {told}"))
    };
    let accidents = ["collisions", "shared_ground"];
    for name in accidents {
        assert_eq!(count(&theirs, name), 0, "with signals at both ends: {}", theirs.0);
        assert!(count(&one_end, name) > 0, "with signals at one end: {}", one_end.0);
        assert!(count(&mutant, name) > 0, "with a train that is not seen: {}", mutant.0);
    }
    assert!(one_end.0["kinds"].as_array().is_some_and(|kinds| kinds.contains(&"frontal".into())), "{}", one_end.0);
    for run in &ours {
        for name in accidents.into_iter().chain(["wrong_points", "lost"]) {
            assert_eq!(count(run, name), 0, "under our devices: {}", run.0);
        }
        assert!(run.1 && count(run, "arrivals") >= 2, "under our devices: {}", run.0);
    }
    assert!(count(&theirs, "arrivals") >= 2, "{}", theirs.0);
    assert!(!mutant.1, "the exit status tells of accidents under our devices");
}
