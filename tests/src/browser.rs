//! A headless Chromium, spoken to over its debugging pipe: real keys, clicks and drags, and what the page then shows.

use std::fs::{File, OpenOptions};
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// A browser with one page.
pub struct Browser {
    process: Child,
    to: File,
    from: BufReader<File>,
    session: String,
    number: u64,
    /// Its profile and pipes, removed at the end.
    _folder: tempfile::TempDir,
}

/// The Chromium that is found here, if there is one.
pub fn chromium() -> Option<PathBuf> {
    let names = ["chromium", "chromium-browser", "google-chrome", "chrome"];
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|path| path.is_file())
}

impl Browser {
    /// A browser with a window of this size, at a page.
    ///
    /// # Panics
    /// If it does not start, or does not load the page.
    pub fn open(chromium: &Path, page: &Path, (width, height): (u32, u32)) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let [input, output] = ["in", "out"].map(|name| folder.path().join(name));
        for pipe in [&input, &output] {
            assert!(Command::new("mkfifo").arg(pipe).status().expect("mkfifo").success());
        }
        // The pipe is on the descriptors 3 and 4.
        let script = r#"exec "$0" --remote-debugging-pipe --headless=new --no-sandbox --disable-gpu --no-first-run --user-data-dir="$3" --window-size="$4" about:blank 3<"$1" 4>"$2""#;
        let process = Command::new("sh")
            .args(["-c", script])
            .arg(chromium)
            .args([&input, &output])
            .arg(folder.path().join("profile"))
            .arg(format!("{width},{height}"))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("a shell");
        let to = OpenOptions::new().write(true).open(&input).expect("the pipe");
        let from = BufReader::new(File::open(&output).expect("the pipe"));
        let mut browser = Self { process, to, from, session: String::new(), number: 0, _folder: folder };
        let targets = browser.ask("Target.getTargets", &json!({}));
        let pages = targets["targetInfos"].as_array().expect("targets").iter().find(|one| one["type"] == "page");
        let id = pages.expect("a page")["targetId"].clone();
        let attached = browser.ask("Target.attachToTarget", &json!({"targetId": id, "flatten": true}));
        attached["sessionId"].as_str().expect("a session").clone_into(&mut browser.session);
        let metrics = json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": false});
        browser.ask("Emulation.setDeviceMetricsOverride", &metrics);
        browser.ask("Page.navigate", &json!({"url": format!("file://{}", page.display())}));
        browser.wait("document.readyState === 'complete' && typeof Player === 'object'");
        browser.settle();
        browser
    }

    /// Sends a command and waits for its result.
    ///
    /// # Panics
    /// If the browser refuses it, or is gone.
    pub fn ask(&mut self, method: &str, params: &Value) -> Value {
        self.number += 1;
        let mut message = json!({"id": self.number, "method": method, "params": params});
        if !self.session.is_empty() {
            message["sessionId"] = json!(self.session);
        }
        self.to.write_all(format!("{message}\0").as_bytes()).expect("a browser that listens");
        loop {
            let mut reply = Vec::new();
            self.from.read_until(0, &mut reply).expect("a browser that speaks");
            assert!(!reply.is_empty(), "the browser has ended");
            reply.pop();
            let reply: Value = serde_json::from_slice(&reply).expect("JSON");
            if reply["id"] == json!(self.number) {
                assert!(reply.get("error").is_none(), "{method}: {reply}");
                return reply["result"].clone();
            }
        }
    }

    /// The value of an expression in the page.
    ///
    /// # Panics
    /// If it throws.
    pub fn value(&mut self, expression: &str) -> Value {
        let asked = json!({"expression": expression, "returnByValue": true, "awaitPromise": true});
        let result = self.ask("Runtime.evaluate", &asked);
        assert!(result.get("exceptionDetails").is_none(), "{expression}: {result}");
        result["result"]["value"].clone()
    }

    /// Waits until an expression is true.
    ///
    /// # Panics
    /// If it is not within 20 s.
    pub fn wait(&mut self, expression: &str) {
        let end = Instant::now() + Duration::from_secs(20);
        while self.value(expression) != json!(true) {
            assert!(Instant::now() < end, "never: {expression}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Waits until what was asked for is drawn.
    pub fn settle(&mut self) {
        self.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))");
    }

    /// Presses a key and lets it go.
    pub fn key(&mut self, key: &str) {
        let text = if key == " " { " " } else { "" };
        for kind in ["keyDown", "keyUp"] {
            let mut params = json!({"type": kind, "key": key, "code": if key == " " { "Space" } else { key }});
            if kind == "keyDown" && !text.is_empty() {
                params["text"] = json!(text);
            }
            self.ask("Input.dispatchKeyEvent", &params);
        }
        self.settle();
    }

    /// Presses the mouse at one place of an element, moves it to another, and lets it go: places as shares of its
    /// width.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn drag(&mut self, selector: &str, from: f64, to: f64) {
        let look = format!(
            "(() => {{ const it = document.querySelector({selector:?}); it.scrollIntoView({{block: 'center'}}); const box = it.getBoundingClientRect(); return [box.x, box.y + Math.min(box.height, innerHeight) / 2, box.width]; }})()"
        );
        let place = self.value(&look);
        let number = |at: usize| place[at].as_f64().expect("a place");
        let (left, y, width) = (number(0), number(1), number(2));
        let mut mouse = |kind: &str, share: f64, buttons: u32| {
            let params = json!({"type": kind, "x": left + share * width, "y": y, "button": "left", "buttons": buttons, "clickCount": 1});
            self.ask("Input.dispatchMouseEvent", &params);
        };
        mouse("mousePressed", from, 1);
        if (from - to).abs() > 0.0 {
            mouse("mouseMoved", f64::midpoint(from, to), 1);
            mouse("mouseMoved", to, 1);
        }
        mouse("mouseReleased", to, 0);
        self.settle();
    }

    /// Clicks on the middle of an element.
    pub fn click(&mut self, selector: &str) {
        self.drag(selector, 0.5, 0.5);
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        drop(self.process.kill());
        drop(self.process.wait());
    }
}
