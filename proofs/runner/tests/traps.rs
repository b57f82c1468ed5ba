//! The traps: what is declared is there and named in proofs/SOUNDNESS.md, and an engine that is wrong walks into one.

use atc_prover::traps::{Outcome, Trap, Way, list, trials};
use atc_prover::{Solver, Tools, in_parallel, root};
use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[test]
fn every_trap_has_a_file_and_every_file_is_a_trap() {
    let traps = list(&root()).unwrap();
    assert!(traps.len() >= 37, "only {} traps", traps.len());
    let mut files: BTreeSet<String> = ["lib.rs", "native.c", "trap.h", "direct.h", "traps.toml"].map(Into::into).into();
    assert!(traps.iter().all(|trap| files.insert(trap.file.clone())), "a file of two traps");
    let found = fs::read_dir(root().join("proofs/traps")).unwrap();
    let found: BTreeSet<String> = found.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(found, files);
    for solver in ["search", "proof", "outside", "verdicts"] {
        assert!(traps.iter().any(|trap| trap.name == solver && trap.every_way), "{solver} is for every solver");
    }
}

/// The rows of the table of ways to a false proof: their cells.
fn ways_to_a_false_proof() -> Vec<Vec<String>> {
    let text = fs::read_to_string(root().join("proofs/SOUNDNESS.md")).unwrap();
    let section = text.split("\n## ").find(|section| section.starts_with("Ways to a false proof")).unwrap();
    let rows = section.lines().filter(|line| line.starts_with("| ")).skip(1);
    let cells = |line: &str| line.trim_matches('|').split(" | ").map(|cell| cell.trim().to_owned()).collect();
    rows.map(cells).collect()
}

#[test]
fn soundness_names_every_trap_and_no_other_and_every_guard_has_a_test() {
    let traps = list(&root()).unwrap();
    let declared: BTreeSet<_> = traps.iter().map(|trap| trap.name.as_str()).collect();
    let rows = ways_to_a_false_proof();
    assert!(rows.len() >= 15, "only {} ways to a false proof", rows.len());
    let mut named = BTreeSet::new();
    for row in &rows {
        assert_eq!(row.len(), 5, "{row:?}");
        let tests: Vec<_> = row[3].split('`').skip(1).step_by(2).collect();
        for test in &tests {
            if let Some((file, function)) = test.split_once("::") {
                let text = fs::read_to_string(root().join("proofs/runner").join(file)).unwrap();
                assert!(text.contains(&format!("fn {function}(")), "{test} is no test");
            } else {
                assert!(declared.contains(test), "`{test}` is no trap");
                named.insert(*test);
            }
        }
        assert!(!tests.is_empty() || row[3].starts_with("none"), "a guard without a test: {row:?}");
    }
    assert_eq!(named, declared, "traps that SOUNDNESS.md names, and traps that there are");
}

/// What Kani does not check of itself (issues 4294 and 4282): a contract in place of a function, and a quantifier.
#[test]
fn no_contract_is_believed_no_quantifier_is_used_and_no_part_is_smaller() {
    let mut folders: Vec<PathBuf> = ["kernel/src", "proofs/src"].map(|folder| root().join(folder)).into();
    let mut seen = 0;
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = fs::read_to_string(&path).unwrap();
            // Nor is a harness smaller when it is compiled in a part of them: `small` is for wrong kernels only.
            let words = ["stub_verified", "kani::forall", "kani::exists", "cfg!(chosen", "cfg!(any(chosen"];
            let found = words.iter().find(|word| text.contains(**word));
            assert_eq!(found, None, "{}", path.display());
            seen += 1;
        }
    }
    assert!(seen > 40, "only {seen} files");
}

/// An engine with one thing wrong.
struct Wrong {
    /// What is wrong with it.
    what: &'static str,
    /// The tool that is replaced.
    tool: &'static str,
    /// What stands for it: lines of sh, of which the last should be `real "$@"`.
    script: &'static str,
    /// How it is asked.
    way: Way,
    /// The traps that it must walk into.
    into: &'static [&'static str],
}

const ONCE: Way = Way::Once(Solver::Auto);

const WRONG: [Wrong; 31] = [
    Wrong {
        what: "jumps back as wasm2c writes them",
        tool: "cbmc",
        script: "edit harness.h 's/goto var_C/goto var_L/'; real \"$@\"",
        way: ONCE,
        into: &["loops"],
    },
    Wrong {
        what: "a jump ends at the nearer join",
        tool: "cbmc",
        script: "edit harness.h 's/goto var_B0;/goto var_B1;/'; real \"$@\"",
        way: ONCE,
        into: &["exits_two", "exits_four", "exits_loop", "exits_if", "joins_many", "table"],
    },
    Wrong {
        what: "a jump out of a region is forgotten",
        tool: "cbmc",
        script: "edit harness.h 's/{goto var_B1;}/{}/'; real \"$@\"",
        way: ONCE,
        into: &["exits_two", "exits_loop", "exits_if", "exits_value", "joins_many"],
    },
    Wrong {
        what: "a region is left out",
        tool: "cbmc",
        script: "edit harness.h 's/^  w2c_h_[a-z_0-9]*_r[0-9]*(instance);//'; real \"$@\"",
        way: ONCE,
        into: &["exits_two", "exits_loop", "exits_if", "joins_many", "regions"],
    },
    Wrong {
        what: "a variable keeps what an earlier call left in it",
        tool: "cbmc",
        script: "edit harness.h 's/^  w2c_h_regions_0_l[0-9] = [0-9];//'; real \"$@\"",
        way: ONCE,
        into: &["regions"],
    },
    Wrong {
        what: "a parameter is not handed over",
        tool: "cbmc",
        script: "edit harness.h 's/^  w2c_h_regions_0_p[0-9] = var_p[0-9];//'; real \"$@\"",
        way: ONCE,
        into: &["regions"],
    },
    Wrong {
        what: "the lowest frame is at address 0",
        tool: "wasm-ld",
        script: "for a; do shift; [ \"$a\" != -zstack-size=32 ] || a=-zstack-size=16; set -- \"$@\" \"$a\"; done; real \"$@\"",
        way: ONCE,
        into: &["lowest"],
    },
    Wrong {
        what: "a panic where its jump was is none",
        tool: "cbmc",
        script: "edit harness.h 's/ UNREACHABLE; }/ }/'; real \"$@\"",
        way: ONCE,
        into: &["panics"],
    },
    Wrong {
        what: "a jump of compiled code is forgotten",
        tool: "cbmc",
        script: "edit harness.c 's/{goto var_B[0-9]*;}/{}/'; real \"$@\"",
        way: ONCE,
        into: &["exits"],
    },
    Wrong {
        what: "a case of a switch goes the way of another",
        tool: "cbmc",
        script: "edit harness.h 's/case 1: /case 9: /'; real \"$@\"",
        way: ONCE,
        into: &["table", "loops_switch"],
    },
    Wrong {
        what: "a case of a compiled switch goes the way of another",
        tool: "cbmc",
        script: "edit harness.c 's/case 1: /case 9: /'; real \"$@\"",
        way: ONCE,
        into: &["switch"],
    },
    Wrong {
        what: "data segments are not loaded",
        tool: "cbmc",
        script: "edit harness.h 's/^#define DATA .*/#define DATA {0}/'; real \"$@\"",
        way: ONCE,
        into: &["constants"],
    },
    Wrong {
        what: "no unwinding assertions",
        tool: "cbmc",
        script: "without --unwinding-assertions \"$@\"",
        way: ONCE,
        into: &["unwinding"],
    },
    Wrong {
        what: "too few rounds, and no word of it",
        tool: "cbmc",
        script: "without --unwinding-assertions --unwind 1 \"$@\"",
        way: ONCE,
        into: &["calls", "loops_last", "loops_nested", "late_label"],
    },
    Wrong {
        what: "64 bits are 32",
        tool: "cbmc",
        script: "edit harness.h 's/uint64_t u64;/uint32_t u64;/'; real \"$@\"",
        way: ONCE,
        into: &["products", "signs"],
    },
    Wrong {
        what: "the distance of a shift is not masked",
        tool: "cbmc",
        script: "edit harness.c 's/ & 31)/)/;s/ & 63)/)/'; real \"$@\"",
        way: ONCE,
        into: &["shifts"],
    },
    Wrong {
        what: "signs are not extended",
        tool: "cbmc",
        script: "edit driver.c 's/(s32)(s8)//;s/(s32)(s16)//'; real \"$@\"",
        way: ONCE,
        into: &["casts"],
    },
    Wrong {
        what: "stores are lost",
        tool: "cbmc",
        script: "edit driver.c '/^ *words.a . 4. = /d'; real \"$@\"",
        way: ONCE,
        into: &["cells", "bytes"],
    },
    Wrong {
        what: "a wide access is at a multiple of its width",
        tool: "cbmc",
        script: "edit driver.c 's/if ((a & 3) == 0) /if (1) /'; real \"$@\"",
        way: ONCE,
        into: &["unaligned"],
    },
    Wrong {
        what: "memory has no end",
        tool: "cbmc",
        script: "edit driver.c 's/(a) + (n) <= MEMORY/1/'; real \"$@\"",
        way: ONCE,
        into: &["stack"],
    },
    Wrong {
        what: "a panic is no failure",
        tool: "cbmc",
        script: "edit driver.c '/\"trap: panic\"/d'; real \"$@\"",
        way: ONCE,
        into: &["overflow", "bounds", "division"],
    },
    Wrong {
        what: "arithmetic wraps in silence",
        tool: "rustc",
        script: "without -Coverflow-checks=on \"$@\"",
        way: ONCE,
        into: &["overflow"],
    },
    Wrong {
        what: "all claims in one assertion",
        tool: "cbmc",
        script: "edit driver.c 's/\"claim \" #n/\"claim 0\"/'; real \"$@\"",
        way: ONCE,
        into: &["verdicts"],
    },
    Wrong {
        what: "everything can be reached",
        tool: "cbmc",
        script:
            "edit driver.c 's/^int main(void) {/&__CPROVER_assert(0, \"reach 1\");__CPROVER_assert(0, \"reach 3\");/'
                 real \"$@\"",
        way: ONCE,
        into: &["vacuity"],
    },
    Wrong {
        what: "assumptions are dropped",
        tool: "cbmc",
        script: "edit driver.c 's/__CPROVER_assume(holds != 0);//'; real \"$@\"",
        way: ONCE,
        into: &["vacuity", "constants", "assumed"],
    },
    Wrong {
        what: "nothing is said of a missing body",
        tool: "cbmc",
        script: "real \"$@\" 2>&1 | sed 's/no body for/all is well with/'; [ $# -eq 0 ] || exit 10",
        way: ONCE,
        into: &["missing", "unseen_copy"],
    },
    Wrong {
        what: "every answer is yes",
        tool: "cbmc",
        script: "real \"$@\" | sed 's/: FAILURE$/: SUCCESS/;s/^[*][*] [0-9]* of/** 0 of/;s/FAILED$/SUCCESSFUL/'",
        way: ONCE,
        into: &["verdicts", "overflow", "search", "loops_last", "rounds"],
    },
    Wrong {
        what: "nothing is said of how far loops are unwound",
        tool: "cbmc",
        script: "said=$(real \"$@\"); status=$?; printf '%s\\n' \"$said\" | grep -v '^Unwinding loop'; exit $status",
        way: ONCE,
        into: &["turns"],
    },
    Wrong {
        what: "every answer is no",
        tool: "cbmc",
        script: "real \"$@\" | sed 's/: SUCCESS$/: FAILURE/;s/^[*][*] [0-9]* of \\([0-9]*\\)/** \\1 of \\1/'; exit 10",
        way: ONCE,
        into: &["proof"],
    },
    Wrong {
        what: "a SAT solver that finds nothing",
        tool: "kissat",
        script: "echo 's UNSATISFIABLE'; exit 20",
        way: Way::Twice(Solver::Kissat),
        into: &["search", "outside", "verdicts"],
    },
    Wrong {
        what: "an SMT solver that finds nothing",
        tool: "z3",
        script: "echo unsat",
        way: Way::Twice(Solver::Z3),
        into: &["search", "outside", "verdicts"],
    },
];

/// What the scripts above use.
const TOOLS: &str = r#"#!/bin/sh
real() { REAL "$@"; }
driver=$1
edit() { # $1: a file beside the driver, $2: what sed makes of it, once; it must make something
  file=${driver%/*}/$1
  [ -e "$file.right" ] && return
  cp "$file" "$file.right" && sed -i "$2" "$file" || exit 98
  if cmp -s "$file" "$file.right"; then exit 99; fi
}
without() { # $1: an option that is dropped
  dropped=$1
  shift
  for argument do
    shift
    [ "$argument" = "$dropped" ] || set -- "$@" "$argument"
  done
  real "$@"
}
"#;

/// The provers of this checkout, one of them replaced.
fn kit(folder: &Path, wrong: &Wrong) -> Tools {
    let (provers, kit) = (root().join("target/provers"), folder.join("kit"));
    let bin = kit.join("target/provers/bin");
    fs::create_dir_all(&bin).unwrap();
    fs::copy(provers.join("tools.json"), kit.join("target/provers/tools.json")).unwrap();
    let include = kit.join("target/provers/include");
    if !include.exists() {
        std::os::unix::fs::symlink(provers.join("include"), include).unwrap();
    }
    for entry in fs::read_dir(provers.join("bin")).unwrap() {
        let tool: PathBuf = entry.unwrap().path();
        // A run before has put the guards of its solvers beside them.
        if tool.is_dir() {
            continue;
        }
        let name = tool.file_name().unwrap();
        let script = if name == wrong.tool { wrong.script } else { "real \"$@\"" };
        let text = TOOLS.replace("REAL", &format!("'{}'", tool.display())) + script + "\n";
        fs::write(bin.join(name), text).unwrap();
        fs::set_permissions(bin.join(name), fs::Permissions::from_mode(0o755)).unwrap();
    }
    Tools::find(&kit).unwrap()
}

#[test]
fn every_trap_has_a_wrong_engine() {
    // What no version of an engine is wrong about is no trap: each must catch one. The eight lines have caught theirs.
    let caught: BTreeSet<_> = WRONG.iter().flat_map(|wrong| wrong.into).copied().collect();
    let traps = list(&root()).unwrap();
    let idle: Vec<_> = traps.iter().filter(|trap| trap.known_wrong.is_empty()).map(|trap| trap.name.as_str()).collect();
    assert_eq!(caught, idle.into_iter().collect());
}

#[test]
fn a_wrong_engine_walks_into_its_traps() {
    let Ok(real) = Tools::find(&root()) else {
        println!("not run: the provers are not installed (ci/install-provers)");
        return;
    };
    let all = list(&root()).unwrap();
    let escaped = in_parallel(2, WRONG.len(), |number| {
        let wrong = &WRONG[number];
        if !real.versions.contains_key(wrong.tool) {
            println!("not run: {} ({} is not there)", wrong.what, wrong.tool);
            return Vec::new();
        }
        let folder = root().join("target/proofs/wrong-engines").join(number.to_string());
        let tools = kit(&folder, wrong);
        let traps: Vec<Trap> = all.iter().filter(|trap| wrong.into.contains(&trap.name.as_str())).cloned().collect();
        assert_eq!(traps.len(), wrong.into.len(), "{}", wrong.what);
        let ways = |_: &Trap| vec![wrong.way];
        let found =
            trials(&tools, &root(), &folder.join("traps"), (&traps, &ways), (1, Duration::from_mins(5))).unwrap();
        let mut escaped = Vec::new();
        for trial in found {
            println!("{}: {}: {:?}", wrong.what, trial.trap, trial.outcome);
            // Silence would be noticed, too; but it is not what is wrong here.
            if !matches!(trial.outcome, Outcome::Wrong(_)) {
                escaped.push(format!("{}: {}: {:?}", wrong.what, trial.trap, trial.outcome));
            }
        }
        escaped
    });
    let escaped = escaped.concat();
    assert!(escaped.is_empty(), "wrong engines that are not noticed:\n{}", escaped.join("\n"));
}
