//! `modelDescription.xml`, from the table of variables and the configuration.

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use sha2::{Digest as _, Sha256};

use crate::instance::CATEGORIES;
use crate::variables::{Causality, ENUMERATIONS, FRAME_BYTES, Kind, VARIABLES, Variable};

/// The name of the library in the package, without its ending.
pub const IDENTIFIER: &str = "atc_fmi";

/// The token by which a library knows its own XML and configuration.
pub fn token(config: &[u8]) -> String {
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    hash.update(format!("{VARIABLES:?}"));
    hash.update(config);
    let mut first = [0; 16];
    first.copy_from_slice(&hash.finalize()[..16]);
    let hex = format!("{:032x}", u128::from_be_bytes(first));
    format!("{{{}-{}-{}-{}-{}}}", &hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..])
}

type Written = io::Result<()>;

/// The XML for a configuration with this logic cycle.
///
/// # Errors
/// None is known: it is written to memory.
pub fn xml(config: &[u8], cycle_ms: u32) -> io::Result<Vec<u8>> {
    let mut out = Writer::new_with_indent(Vec::new(), b' ', 2);
    out.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let (token, step) = (token(config), format!("{}", f64::from(cycle_ms) / 1000.0));
    let about = [
        ("fmiVersion", "3.0"),
        ("modelName", "atc-on-board"),
        ("instantiationToken", &token),
        ("description", "The on-board device of an automatic train control system, from its antennas to the brake"),
        ("version", env!("CARGO_PKG_VERSION")),
        ("license", "MIT OR Apache-2.0"),
        ("generationTool", concat!("atc-fmi ", env!("CARGO_PKG_VERSION"))),
        ("variableNamingConvention", "flat"),
    ];
    out.create_element("fmiModelDescription").with_attributes(about).write_inner_content(|out| {
        let can = [
            ("modelIdentifier", IDENTIFIER),
            ("canGetAndSetFMUState", "true"),
            ("canSerializeFMUState", "false"),
            ("canHandleVariableCommunicationStepSize", "false"),
            ("fixedInternalStepSize", &step),
            ("hasEventMode", "false"),
            ("canReturnEarlyAfterIntermediateUpdate", "false"),
            ("mightReturnEarlyFromDoStep", "false"),
        ];
        out.create_element("CoSimulation").with_attributes(can).write_empty()?;
        out.create_element("UnitDefinitions").write_inner_content(units)?;
        out.create_element("TypeDefinitions").write_inner_content(types)?;
        out.create_element("LogCategories").write_inner_content(|out| {
            for (name, what) in CATEGORIES {
                let category = [("name", name), ("description", what)];
                out.create_element("Category").with_attributes(category).write_empty()?;
            }
            Ok(())
        })?;
        let experiment = [("startTime", "0"), ("stepSize", &step)];
        out.create_element("DefaultExperiment").with_attributes(experiment).write_empty()?;
        out.create_element("ModelVariables").write_inner_content(|out| {
            for (place, variable) in VARIABLES.iter().enumerate() {
                write(out, place, variable)?;
            }
            Ok(())
        })?;
        out.create_element("ModelStructure").write_inner_content(structure).map(drop)
    })?;
    let mut text = out.into_inner();
    text.push(b'\n');
    Ok(text)
}

/// Units with their exponents of m and s, and how many of SI's one of them is.
const UNITS: [(&str, &[(&str, &str)]); 5] = [
    ("s", &[("s", "1")]),
    ("m", &[("m", "1")]),
    ("Hz", &[("s", "-1")]),
    ("km/h", &[("m", "1"), ("s", "-1"), ("factor", "0.2777777777777778")]),
    ("dB", &[]),
];

fn units(out: &mut Writer<Vec<u8>>) -> Written {
    for (name, base) in UNITS {
        let unit = out.create_element("Unit").with_attribute(("name", name));
        if base.is_empty() {
            unit.write_empty()?;
        } else {
            unit.write_inner_content(|out| {
                out.create_element("BaseUnit").with_attributes(base.iter().copied()).write_empty().map(drop)
            })?;
        }
    }
    Ok(())
}

fn types(out: &mut Writer<Vec<u8>>) -> Written {
    for words in ENUMERATIONS {
        out.create_element("EnumerationType").with_attribute(("name", words.name)).write_inner_content(|out| {
            for (number, word) in words.words.iter().enumerate() {
                let item = [("name", *word), ("value", &number.to_string())];
                out.create_element("Item").with_attributes(item).write_empty()?;
            }
            Ok(())
        })?;
    }
    Ok(())
}

fn write(out: &mut Writer<Vec<u8>>, place: usize, variable: &Variable) -> Written {
    let (causality, variability) = match variable.causality {
        Causality::Independent => ("independent", "continuous"),
        Causality::Input => ("input", "discrete"),
        Causality::Output => ("output", "discrete"),
    };
    let mut about: Vec<(&str, String)> = vec![
        ("name", variable.name.into()),
        ("valueReference", place.to_string()),
        ("causality", causality.into()),
        ("variability", variability.into()),
        ("description", variable.what.into()),
    ];
    let mut range = |least: String, most: String| about.extend([("min", least), ("max", most)]);
    match variable.kind {
        Kind::Float64(unit, limits) => {
            if let Some([least, most]) = limits {
                range(least.to_string(), most.to_string());
            }
            about.push(("unit", unit.into()));
        }
        Kind::UInt8(least, most) => range(least.to_string(), most.to_string()),
        Kind::UInt16(least, most) => range(least.to_string(), most.to_string()),
        Kind::Enumeration(words) => about.push(("declaredType", words.name.into())),
        Kind::Binary => about.push(("maxSize", FRAME_BYTES.to_string())),
        Kind::Int8 | Kind::Boolean => {}
    }
    let input = variable.causality == Causality::Input;
    let start = match variable.kind {
        Kind::UInt8(least, _) => least.to_string(),
        Kind::UInt16(least, _) => least.to_string(),
        Kind::Boolean => "false".into(),
        Kind::Float64(..) | Kind::Int8 | Kind::Enumeration(_) | Kind::Binary => "0".into(),
    };
    let binary = variable.kind == Kind::Binary;
    if input && !binary {
        about.push(("start", start));
    }
    let attributes = about.iter().map(|(name, value)| (*name, value.as_str()));
    let element = out.create_element(variable.kind.name()).with_attributes(attributes);
    if input && binary {
        let none = |out: &mut Writer<Vec<u8>>| {
            out.create_element("Start").with_attribute(("value", "")).write_empty().map(drop)
        };
        return element.write_inner_content(none).map(drop);
    }
    element.write_empty().map(drop)
}

/// No output follows from an input before a step has been made.
fn structure(out: &mut Writer<Vec<u8>>) -> Written {
    for kind in ["Output", "InitialUnknown"] {
        for (place, variable) in VARIABLES.iter().enumerate() {
            if variable.causality == Causality::Output {
                let unknown = [("valueReference", place.to_string()), ("dependencies", String::new())];
                let unknown = unknown.iter().map(|(name, value)| (*name, value.as_str()));
                out.create_element(kind).with_attributes(unknown).write_empty()?;
            }
        }
    }
    Ok(())
}
