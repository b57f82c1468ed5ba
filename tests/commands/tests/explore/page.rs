//! The page in a headless Chromium: keys, clicks, drags and playing, with real input; what is on the plan; sizes;
//! printing.
//! Where there is no Chromium this says so and tests nothing: see `logic.rs` and `data.rs` for what is tested without
//! one.

use std::path::PathBuf;

use atc_tests::browser::{Browser, chromium};
use serde_json::{Value, json};

use super::{filmed, random_session, text};

/// A page in a folder, and a browser at it; nothing where there is none.
fn opened(page: &str, size: (u32, u32)) -> Option<(Browser, tempfile::TempDir)> {
    let Some(chromium) = chromium() else {
        eprintln!("NOT RUN: no chromium here: nothing is known of how the page behaves in a browser");
        return None;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let file: PathBuf = folder.path().join("film.html");
    std::fs::write(&file, page).expect("a page");
    Some((Browser::open(&chromium, &file, size), folder))
}

fn example() -> String {
    filmed(&text("oracle/examples/interlocking.jsonl")).page()
}

fn frame(browser: &mut Browser) -> i64 {
    browser.value("Player.frame()").as_i64().expect("a frame")
}

#[test]
fn keys_clicks_drags_and_playing_move_the_film() {
    let Some((mut browser, _folder)) = opened(&example(), (1280, 900)) else { return };
    assert_eq!(frame(&mut browser), 0);
    for (key, expected) in [
        ("ArrowRight", 1),
        ("ArrowRight", 2),
        ("ArrowLeft", 1),
        ("End", 131),
        ("ArrowRight", 131),
        ("Home", 0),
        ("ArrowLeft", 0),
    ] {
        browser.key(key);
        assert_eq!(frame(&mut browser), expected, "{key}");
    }
    // To the next event and back.
    browser.key("ArrowDown");
    let first = frame(&mut browser);
    browser.click("#event-on");
    let second = frame(&mut browser);
    assert!(0 < first && first < second);
    browser.key("ArrowUp");
    assert_eq!(frame(&mut browser), first);
    // The slider, dragged from where it is; a click on the ticks and on an event.
    browser.key("Home");
    browser.drag("#slider", 0.01, 0.5);
    let half = frame(&mut browser);
    assert!((60..72).contains(&half), "{half}");
    browser.click("#ticks");
    assert!((64..=67).contains(&frame(&mut browser)));
    browser.drag("#lanes", 0.95, 0.9);
    assert!(frame(&mut browser) > 100);
    browser.click("#events li:nth-child(1)");
    let listed = browser.value("Number(document.querySelector('#events li').dataset.frame)");
    assert_eq!(json!(frame(&mut browser)), listed);
    // Play by the space bar, pause by it, and on to the end.
    browser.key("Home");
    browser.value("document.activeElement.blur(), document.getElementById('speed').value = 60");
    browser.key(" ");
    browser.wait("Player.frame() > 5");
    browser.key(" ");
    let paused = frame(&mut browser);
    std::thread::sleep(std::time::Duration::from_millis(150));
    assert_eq!((frame(&mut browser), browser.value("Player.isPlaying()")), (paused, json!(false)));
    browser.click("#play");
    browser.wait("Player.frame() === 131 && !Player.isPlaying()");
}

#[test]
fn the_plan_shows_the_frame() {
    let Some((mut browser, _folder)) = opened(&example(), (1280, 900)) else { return };
    // At 30 s a train is in W1, W2 was left just now, and W-1 is set.
    let classes = "(name) => [...document.querySelectorAll(`polyline[data-circuit='${name}']`)].map((line) => line.getAttribute('class'))";
    browser.value("Player.go(30)");
    browser.settle();
    assert_eq!(browser.value(&format!("({classes})('W1')")), json!(["track is-occupied"]));
    assert_eq!(browser.value(&format!("({classes})('W2')")), json!(["track is-waiting"]));
    assert_eq!(browser.value(&format!("({classes})('2T')")), json!(["track"]));
    assert_eq!(browser.value(&format!("({classes})('P1T')")), json!(["track", "track reverse is-off"]));
    assert_eq!(browser.value("document.querySelector('.is-go').dataset.signal"), json!("W"));
    assert_eq!(browser.value("document.querySelectorAll('.under.set').length"), json!(2));
    assert_eq!(browser.value("document.querySelectorAll('.under.overlap').length"), json!(1));
    assert_eq!(browser.value("document.querySelector('text.told').textContent"), json!("▶ to 1T at 75"));
    let now = browser.value("document.getElementById('now').textContent");
    assert_eq!(now, json!("step 30 of 131 · 30 s"));
    let table = browser.value("document.querySelectorAll('.values')[1].innerText");
    assert!(table.as_str().is_some_and(|text| text.contains("W-1") && text.contains("proceed at W")), "{table}");
}

/// What must hold of the page at any size: no letter below 12 px, nothing wider than the window but what scrolls in
/// itself.
const READABLE: &str = "(() => {
  const small = [];
  for (const it of document.querySelectorAll('body *')) {
    if (!it.childNodes.length || ![...it.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim())) continue;
    if (it.closest('script,style,title,noscript,[hidden]')) continue;
    const svg = it.closest('svg');
    const scale = svg ? svg.clientWidth / svg.viewBox.baseVal.width : 1;
    const size = parseFloat(getComputedStyle(it).fontSize) * scale;
    if (size < 11.95) small.push(`${it.tagName} ${it.textContent.slice(0, 20)} ${size}`);
  }
  return { small, wide: document.documentElement.scrollWidth - innerWidth };
})()";

#[test]
fn the_page_is_readable_at_1280_and_at_2560_pixels() {
    let line =
        atc_simulation::line::Line::read(&super::file("simulation/examples/four-stations.toml")).expect("a line");
    let setting = atc_simulation::world::Setting { trains: 20, ..Default::default() };
    let mut world = atc_simulation::world::World::new(&line, setting).expect("a world");
    let simulated = atc_simulation::film::of(&mut world, 300_000, 1_000).expect("a film").page();
    for page in [example(), simulated] {
        for size in [(1280, 900), (2560, 1440)] {
            let Some((mut browser, _folder)) = opened(&page, size) else { return };
            browser.value("Player.go(200)");
            browser.settle();
            let found = browser.value(READABLE);
            assert_eq!(found["small"], json!([]), "{size:?}");
            assert!(found["wide"].as_i64().is_some_and(|wide| wide <= 0), "{size:?}: {found}");
        }
    }
}

#[test]
fn a_frame_is_printed_without_what_plays() {
    let Some((mut browser, _folder)) = opened(&example(), (1280, 900)) else { return };
    browser.value("Player.go(30)");
    browser.settle();
    browser.ask("Emulation.setEmulatedMedia", &json!({"media": "print"}));
    let shown = |selector: &str| format!("getComputedStyle(document.querySelector('{selector}')).display !== 'none'");
    for (selector, expected) in
        [("#play", false), ("#slider", false), ("#happened", false), ("#now", true), ("#plans", true)]
    {
        assert_eq!(browser.value(&shown(selector)), json!(expected), "{selector}");
    }
    let pdf = browser.ask("Page.printToPDF", &json!({"printBackground": true, "preferCSSPageSize": true}));
    assert!(pdf["data"].as_str().is_some_and(|data| data.starts_with("JVBERi") && data.len() > 10_000));
}

/// 10,000 steps: a frame is drawn in well under what the eye takes for a stop, wherever it is.
#[test]
fn every_step_of_a_long_film_is_drawn() {
    let Some((mut browser, _folder)) = opened(&filmed(&random_session(3, 10_000)).page(), (1280, 900)) else { return };
    let took = browser.value(
        "(async () => {
          const next = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
          const took = [];
          for (let at = 0; at < 20; at += 1) {
            const start = performance.now();
            Player.go((at * 7919) % 10000);
            await next();
            took.push(performance.now() - start);
          }
          return took.sort((a, b) => a - b);
        })()",
    );
    let took: Vec<f64> = took.as_array().expect("times").iter().filter_map(Value::as_f64).collect();
    // How fast is a matter of the machine: it is printed, and no test says so.
    println!("a step of 10,000 is drawn within {took:.0?} ms");
    assert_eq!(took.len(), 20, "every step is drawn");
}
