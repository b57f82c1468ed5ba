//! Loops in the C of wasm2c, written so that CBMC follows every path of them.
//!
//! CBMC (6.6.0 at least) loses paths otherwise. Where a *conditional* jump leads backwards, it runs the next round first and puts the
//! path that does not jump aside, at the instruction after the jump. A later round that jumps forward over that instruction, for certain, may skip it
//! without looking: it looks at labels only, and nothing need be a label there. The path put aside is gone, and with it whatever fails on it:
//!
//! ```c
//! int main(void) {
//!   int i = 0, x = nondet_int();
//! back:
//!   if (i == 1) goto done;
//!   i++;
//!   if (x) goto back;
//!   __CPROVER_assert(0, "fails when x is 0; cbmc 6.6.0 says SUCCESS");
//! done:
//!   return 0;
//! }
//! ```
//!
//! wasm's `br_if` to a loop is such a jump. So every jump back goes forward first, to one place behind all of them, and from there back without a
//! condition. The self-test `loops` would see it if that were not enough.

use std::collections::BTreeMap;

/// The C with one way back for each loop, and none that is conditional.
///
/// # Errors
/// Text that is not as wasm2c 1.0.36 writes it.
pub fn one_way_back(text: &str) -> Result<String, String> {
    by_function(text, rewrite)
}

/// The C with each of its functions written anew, line by line.
pub fn by_function(text: &str, rewrite: fn(&[&str], &mut String) -> Result<(), String>) -> Result<String, String> {
    let mut written = String::with_capacity(text.len() + text.len() / 4);
    let mut function: Vec<&str> = Vec::new();
    for line in text.lines() {
        function.push(line);
        // wasm2c closes a function, and nothing else, in the first column.
        if line.starts_with('}') {
            rewrite(&function, &mut written)?;
            function.clear();
        }
    }
    rewrite(&function, &mut written)?;
    Ok(written)
}

/// The number of the loop that a line jumps to.
fn jump(line: &str) -> Option<&str> {
    line.split_once("goto var_L").and_then(|(_, rest)| rest.split_once(';')).map(|(number, _)| number)
}

/// The number of the loop that a line begins.
fn label(line: &str) -> Option<&str> {
    line.trim().strip_prefix("var_L").and_then(|rest| rest.split_once(':')).map(|(number, _)| number)
}

fn rewrite(function: &[&str], written: &mut String) -> Result<(), String> {
    let mut begins = BTreeMap::new();
    let mut last = BTreeMap::new();
    for (place, line) in function.iter().enumerate() {
        if line.contains("var_C") || line.contains("var_E") || line.matches("goto ").count() > 1 {
            return Err(format!("C that wasm2c 1.0.36 does not write: `{}`", line.trim()));
        }
        if let Some(number) = label(line) {
            begins.insert(number, place);
        }
        if let Some(number) = jump(line) {
            last.insert(number, place);
        }
    }
    for (number, place) in &last {
        if begins.get(number).is_none_or(|begin| begin > place) {
            return Err(format!("a jump to var_L{number}, which is not before it"));
        }
    }
    for (place, line) in function.iter().enumerate() {
        written.push_str(&line.replace("goto var_L", "goto var_C"));
        written.push('\n');
        if let Some(number) = jump(line).filter(|number| last.get(number) == Some(&place)) {
            let way_back =
                format!("  goto var_E{number};\n  var_C{number}:;\n  goto var_L{number};\n  var_E{number}:;\n");
            written.push_str(&way_back);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::one_way_back;

    #[test]
    fn a_loop_has_one_way_back_behind_all_its_jumps() {
        let text = "u32 f(void) {\n  var_L1: \n    if (var_i0) {goto var_L1;}\n    var_i0 = 1u;\n    goto var_L1;\n  var_B0:;\n}\n";
        let wanted = "u32 f(void) {\n  var_L1: \n    if (var_i0) {goto var_C1;}\n    var_i0 = 1u;\n    goto var_C1;\n  goto var_E1;\n  \
                      var_C1:;\n  goto var_L1;\n  var_E1:;\n  var_B0:;\n}\n";
        assert_eq!(one_way_back(text).as_deref(), Ok(wanted));
    }

    #[test]
    fn loops_of_two_functions_are_told_apart() {
        let text = "void f(void) {\n  var_L1: \n    if (var_i0) {goto var_L1;}\n}\n";
        let written = one_way_back(&text.repeat(2)).unwrap_or_default();
        assert_eq!(written.matches("goto var_L1;").count(), 2);
        assert_eq!(written.matches("goto var_C1;").count(), 2);
    }

    #[test]
    fn what_has_no_loop_stays() {
        let text = "void f(void) {\n  if (var_i0) {goto var_B1;}\n  var_B1:;\n}\n";
        assert_eq!(one_way_back(text).as_deref(), Ok(text));
    }

    #[test]
    fn c_of_another_kind_is_an_error() {
        for text in [
            "  goto var_L1;\n  var_L1:\n}\n",
            "  goto var_L1;\n}\n",
            "  var_C1:;\n}\n",
            "  if (a) {goto var_B1;} else {goto var_L2;}\n}\n",
        ] {
            assert!(one_way_back(text).is_err(), "{text}");
        }
    }
}
