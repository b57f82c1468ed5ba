//! What the page decides, without a browser: its logic run by Node, where there is one. What the data say is tested in
//! Rust in any case.

use std::process::Command;

use super::{file, filmed, random_session, text};

#[test]
fn the_logic_of_the_page_is_right() {
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    for (name, session) in [("film", text("oracle/examples/interlocking.jsonl")), ("random", random_session(5, 400))] {
        let film = filmed(&session);
        put(&format!("{name}.json"), &serde_json::to_string(&film).expect("JSON"));
        // What Rust reads in each frame, for the page's own way to read it.
        let said: Vec<Vec<&str>> = (0..film.frames)
            .map(|frame| film.channels.iter().map(|channel| film.said(channel, frame)).collect())
            .collect();
        put(&format!("{name}.said.json"), &serde_json::to_string(&said).expect("JSON"));
    }
    put("test.js", include_str!("logic.js"));
    let node = Command::new("node").arg("test.js").arg(file("film/page/logic.js")).current_dir(folder.path()).output();
    match node {
        Err(error) => eprintln!("not run: no node here ({error}); the page's own logic is not tested"),
        Ok(output) => {
            let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
            assert!(output.status.success() && said.trim_end() == "all is right", "{said}{errors}");
        }
    }
}
