//! Rounding, the XML, and calls that no simulation tool should make.

use std::collections::BTreeSet;
use std::ffi::{CString, c_char, c_void};
use std::ptr::{null, null_mut};

use atc_fmi::border::*;
use atc_fmi::instance::Status;
use atc_fmi::rounding::{down, nearest, up, value};
use atc_fmi::variables::{BASIS, BRAKE, Place, VARIABLES};
use atc_fmi::{cycle, description};
use atc_protocol::machine::permitted::Basis;
use atc_protocol::machine::supervision::Brake;
use atc_protocol::names::Named as _;
use quick_xml::Reader;
use quick_xml::events::Event;

#[test]
fn rounding_is_to_the_side_that_is_said() {
    for parts in [10.0, 1000.0] {
        for count in (-70_000..70_000).chain([2_147_483_647, -2_147_483_647]) {
            let exact = value(count, parts);
            assert_eq!([up(exact, parts), down(exact, parts), nearest(exact, parts)], [count; 3], "{exact}");
            let (above, below) = (exact.next_up(), exact.next_down());
            assert_eq!([up(above, parts), down(above, parts), nearest(above, parts)], [count + 1, count, count]);
            assert_eq!([up(below, parts), down(below, parts), nearest(below, parts)], [count, count - 1, count]);
        }
    }
    assert_eq!([up(44.91, 10.0), down(-0.0001, 1000.0), up(-0.0001, 1000.0)], [450, -1, 0]);
    assert_eq!([nearest(-21.505_1, 100.0), nearest(16.500_4, 1000.0)], [-2151, 16_500]);
    // None of these is reached, and none panics.
    for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300] {
        for rounded in [up, down, nearest] {
            rounded(number, 1000.0);
        }
    }
}

#[test]
fn the_step_rounds_to_the_safe_side() {
    let mut values = atc_fmi::variables::Values::default();
    let set = |values: &mut atc_fmi::variables::Values, place, number| {
        values.set(place, atc_fmi::variables::Value::Float64(number));
    };
    for there in [Place::SpeedMeasured, Place::MovedMeasured, Place::FirstMeasured] {
        values.set(there, atc_fmi::variables::Value::Boolean(true));
    }
    set(&mut values, Place::Speed, 44.901);
    set(&mut values, Place::MovedLeast, 0.12345);
    set(&mut values, Place::MovedMost, 0.12345);
    set(&mut values, Place::First, -21.507);
    set(&mut values, Place::MainCode, 16.4999);
    let step = cycle::step(&values).expect("a step");
    assert_eq!(step.speed_km_h.map(|speed| speed.0), Some(450));
    assert_eq!(step.moved_m.map(|ends| ends.map(|end| end.0)), Some([123, 124]));
    assert_eq!(step.first_db.map(|level| level.0), Some(-2151));
    assert_eq!((step.second_db, step.main.code_hz.map(|code| code.0), step.sub.code_hz), (None, Some(16_500), None));
}

#[test]
fn the_words_are_those_of_the_protocol() {
    let sorted = |words: &[&'static str]| words.iter().copied().collect::<BTreeSet<_>>();
    assert_eq!(sorted(BASIS.words), Basis::EVERY.iter().map(|basis| basis.name()).collect());
    assert_eq!(sorted(BRAKE.words), Brake::ALL.iter().map(|brake| brake.name()).collect());
    assert_eq!((BASIS.words[0], BRAKE.words[0]), ("nothing", "emergency"));
}

#[test]
fn the_xml_is_well_formed_and_has_each_variable_once() {
    let xml = description::xml(b"{}", 10).expect("an XML");
    let mut reader = Reader::from_reader(xml.as_slice());
    let (mut open, mut names, mut references, mut outputs) = (Vec::new(), Vec::new(), BTreeSet::new(), 0);
    loop {
        match reader.read_event().expect("well-formed") {
            Event::Start(start) => open.push(start.name().as_ref().to_vec()),
            Event::End(end) => assert_eq!(open.pop().as_deref(), Some(end.name().as_ref())),
            Event::Eof => break,
            _ => {}
        }
    }
    assert!(open.is_empty());
    let mut reader = Reader::from_reader(xml.as_slice());
    let mut within = false;
    loop {
        match reader.read_event().expect("well-formed") {
            Event::Eof => break,
            Event::Start(tag) | Event::Empty(tag) => {
                within |= tag.name().as_ref() == b"ModelVariables";
                let get = |name: &str| {
                    let attribute = tag.try_get_attribute(name).expect("attributes");
                    attribute.map(|attribute| attribute.unescape_value().expect("a text").into_owned())
                };
                if tag.name().as_ref() == b"Output" {
                    outputs += 1;
                } else if within && let (Some(name), Some(reference)) = (get("name"), get("valueReference")) {
                    assert_eq!(reference.parse(), Ok(names.len()), "{name}");
                    assert!(references.insert(reference));
                    names.push(name);
                }
            }
            Event::End(tag) => within &= tag.name().as_ref() != b"ModelVariables",
            _ => {}
        }
    }
    let table: Vec<_> = VARIABLES.iter().map(|variable| variable.name.to_owned()).collect();
    assert_eq!((names, outputs), (table, 9));
}

#[test]
fn a_token_is_of_one_configuration() {
    let (one, other) = (description::token(b"{}"), description::token(b"{ }"));
    assert!(one != other && one.len() == 38 && one.starts_with('{'), "{one}");
}

/// What was logged, kept where the callback finds it.
extern "C" fn keep(environment: *mut c_void, _: i32, _: *const c_char, message: *const c_char) {
    // SAFETY: the environment is the list below, which lives as long as the instance; the message ends with a zero.
    unsafe {
        let kept = &mut *environment.cast::<Vec<String>>();
        kept.push(std::ffi::CStr::from_ptr(message).to_string_lossy().into_owned());
    }
}

/// An instance in resources of its own.
fn instance(config: &str, token: &str, log: &mut Vec<String>) -> *mut c_void {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("config.json"), config).expect("a file");
    let text = |text: &str| CString::new(text).expect("a text");
    let (name, token) = (text("train"), text(token));
    let path = text(folder.path().to_str().expect("a path"));
    let (name, token, path) = (name.as_ptr(), token.as_ptr(), path.as_ptr());
    let log = std::ptr::from_mut(log).cast();
    // SAFETY: texts that end with a zero.
    unsafe { fmi3InstantiateCoSimulation(name, token, path, 0, 0, 0, 0, null(), 0, log, Some(keep), None) }
}

#[test]
fn what_does_not_start() {
    let mut log = Vec::new();
    let right = description::token(b"{}");
    for (config, token) in [
        ("{}", "{00000000-0000-0000-0000-000000000000}".to_owned()),
        ("{}", String::new()),
        ("{ }", right.clone()),
        ("", description::token(b"")),
        ("[]", description::token(b"[]")),
        ("{\"permitted\":{\"cycle_ms\":0}}", description::token(b"{\"permitted\":{\"cycle_ms\":0}}")),
    ] {
        let before = log.len();
        assert!(instance(config, &token, &mut log).is_null(), "{config}");
        assert_eq!(log.len(), before + 1, "{log:?}");
    }
    // SAFETY: null pointers are what is tried.
    let made = unsafe {
        let log = std::ptr::from_mut(&mut log).cast();
        fmi3InstantiateCoSimulation(null(), null(), null(), 0, 0, 0, 0, null(), 0, log, Some(keep), None)
    };
    assert!(made.is_null() && log.last().is_some_and(|said| said.contains("instanceName is a null pointer")));
    let made = fmi3InstantiateModelExchange(null(), null(), null(), 0, 0, null_mut(), None);
    assert!(made.is_null());
}

#[test]
fn malformed_calls_are_refused() {
    let mut log = Vec::new();
    let unit = instance("{}", &description::token(b"{}"), &mut log);
    assert!(!unit.is_null(), "{log:?}");
    let mut number = [0.0; 2];
    let out = number.as_mut_ptr();
    let speed = [Place::Speed as u32, Place::First as u32];
    let unknown = [u32::try_from(VARIABLES.len()).expect("a few"), u32::MAX];
    let output = [Place::Display as u32];
    let (mut size, mut bytes, mut flags) = (0_usize, null(), [0_u8, 2]);
    let frame = [Place::MainFrame as u32];
    let yes = [Place::SpeedMeasured as u32, Place::FirstMeasured as u32];
    // SAFETY: what is not null leads to arrays that are as long as is said.
    unsafe {
        for freed in [null_mut(), std::ptr::without_provenance_mut(usize::MAX)] {
            assert_eq!(fmi3GetFloat64(freed, speed.as_ptr(), 1, out, 1), Status::Error);
            assert_eq!(fmi3Reset(freed), Status::Error);
            fmi3FreeInstance(freed);
        }
        let odd = out.wrapping_byte_add(1);
        let get = |references, count, values, value_count| fmi3GetFloat64(unit, references, count, values, value_count);
        assert_eq!(get(speed.as_ptr(), 2, out, 2), Status::Ok);
        assert_eq!(get(null(), 0, null_mut(), 0), Status::Ok);
        assert_eq!(get(null(), 2, out, 2), Status::Error);
        assert_eq!(get(speed.as_ptr(), 2, null_mut(), 2), Status::Error);
        assert_eq!(get(speed.as_ptr(), 2, odd, 2), Status::Error);
        assert_eq!(get(speed.as_ptr(), 2, out, 1), Status::Error);
        assert_eq!(get(speed.as_ptr(), usize::MAX, out, usize::MAX), Status::Error);
        assert_eq!(get(unknown.as_ptr(), 2, out, 2), Status::Error);
        assert_eq!(get(yes.as_ptr(), 1, out, 1), Status::Error);
        assert_eq!(fmi3GetBinary(unit, frame.as_ptr(), 1, null_mut(), &raw mut bytes, 1), Status::Error);
        assert_eq!(fmi3GetBinary(unit, frame.as_ptr(), 1, &raw mut size, null_mut(), 1), Status::Error);
        assert_eq!(fmi3GetBinary(unit, frame.as_ptr(), 1, &raw mut size, &raw mut bytes, 1), Status::Ok);
        assert!(size == 0 && !bytes.is_null());
        assert_eq!(fmi3GetFMUState(unit, null_mut()), Status::Error);
        assert_eq!(fmi3FreeFMUState(unit, null_mut()), Status::Error);
        assert_eq!(fmi3SetFMUState(unit, std::ptr::without_provenance_mut(77)), Status::Error);
        assert_eq!(fmi3SetDebugLogging(unit, 1, 1, null()), Status::Error);
        assert_eq!(fmi3SetDebugLogging(unit, 1, 0, null()), Status::Ok);
        assert_eq!(fmi3EnterInitializationMode(unit, 0, 0.0, f64::NAN, 0, 0.0), Status::Error);

        let mut state = null_mut();
        assert_eq!(fmi3GetFMUState(unit, &raw mut state), Status::Ok);
        let set = |references, count, values, value_count| {
            let status = fmi3SetFloat64(unit, references, count, values, value_count);
            // What could not be set stops the instance; the state before is put back for the next trial.
            assert_eq!(fmi3SetFMUState(unit, state), Status::Ok);
            status
        };
        assert_eq!(set(speed.as_ptr(), 2, out, 2), Status::Ok);
        assert_eq!(set(null(), 1, out, 1), Status::Error);
        assert_eq!(set(speed.as_ptr(), 1, null(), 1), Status::Error);
        assert_eq!(set(speed.as_ptr(), 1, odd, 1), Status::Error);
        assert_eq!(set(speed.as_ptr(), 2, out, 1), Status::Error);
        assert_eq!(set(unknown.as_ptr(), 1, out, 1), Status::Error);
        assert_eq!(set(output.as_ptr(), 1, out, 1), Status::Error);
        assert_eq!(set([Place::Time as u32].as_ptr(), 1, out, 1), Status::Error);
        // None is set if one is wrong: 2 is no Boolean.
        flags[0] = 1;
        assert_eq!(fmi3SetBoolean(unit, yes.as_ptr(), 2, flags.as_ptr(), 2), Status::Error);
        assert_eq!(fmi3GetBoolean(unit, yes.as_ptr(), 2, flags.as_mut_ptr(), 2), Status::Ok);
        assert_eq!(flags, [0, 0]);
        let (fourteen, none): ([usize; 1], [*const u8; 1]) = ([14], [null()]);
        assert_eq!(fmi3SetFMUState(unit, state), Status::Ok);
        assert_eq!(fmi3SetBinary(unit, frame.as_ptr(), 1, fourteen.as_ptr(), none.as_ptr(), 1), Status::Error);
        assert_eq!(fmi3SetFMUState(unit, state), Status::Ok);
        assert_eq!(fmi3SetBinary(unit, frame.as_ptr(), 1, [0].as_ptr(), none.as_ptr(), 1), Status::Ok);
        assert_eq!(fmi3SetInt32(unit, yes.as_ptr(), 1, null(), 1), Status::Error);
        assert_eq!(fmi3ExitInitializationMode(unit), Status::Error);
        assert_eq!(fmi3SetFMUState(unit, state), Status::Ok);
        assert_eq!(fmi3FreeFMUState(unit, &raw mut state), Status::Ok);
        assert!(state.is_null());
        assert_eq!(fmi3FreeFMUState(unit, &raw mut state), Status::Ok);

        assert_eq!(fmi3EnterInitializationMode(unit, 0, 0.0, 5.0, 0, 0.0), Status::Ok);
        assert_eq!(fmi3ExitInitializationMode(unit), Status::Ok);
        let [mut one, mut two, mut three] = [7_u8; 3];
        let (one, two, three) = (&raw mut one, &raw mut two, &raw mut three);
        let time = Place::Time as u32;
        assert_eq!(fmi3DoStep(unit, 5.0, 0.01, 1, null_mut(), two, three, out), Status::Error);
        assert_eq!(fmi3DoStep(unit, 5.0, 0.01, 1, one, two, three, null_mut()), Status::Error);
        assert_eq!((fmi3GetFloat64(unit, &raw const time, 1, out, 1), number[0]), (Status::Ok, 5.0));
        assert_eq!(fmi3DoStep(unit, 5.0, 0.01, 1, one, two, three, out), Status::Ok);
        assert_eq!((number[0], *one, *two, *three), (5.01, 0, 0, 0));
    }
    fmi3FreeInstance(unit);
    assert_eq!(fmi3Reset(unit), Status::Error);
    assert!(log.iter().all(|said| said.len() > 15), "{log:?}");
}
