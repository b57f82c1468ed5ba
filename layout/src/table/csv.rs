//! One line of comma-separated values (RFC 4180).

/// Appends the cells as a line.
pub(super) fn line(text: &mut String, cells: &[String]) {
    let quoted: Vec<String> = cells
        .iter()
        .map(|cell| {
            // A spreadsheet would take these for a formula.
            let guard = if cell.starts_with(['=', '+', '-', '@']) { "'" } else { "" };
            if cell.contains([',', '"', '\n', '\r']) {
                format!("\"{guard}{}\"", cell.replace('"', "\"\""))
            } else {
                format!("{guard}{cell}")
            }
        })
        .collect();
    text.push_str(&quoted.join(","));
    text.push_str("\r\n");
}
