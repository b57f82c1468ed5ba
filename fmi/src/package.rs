//! The unit as a file: a zip archive with the XML, the library and the configuration.

use std::io::{self, Cursor, Write as _};
use std::path::PathBuf;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::description::{IDENTIFIER, xml};

/// FMI's name of the platform that this was built for; none if FMI has none.
pub fn platform() -> Option<String> {
    let system = match std::env::consts::OS {
        "linux" => "linux",
        "macos" => "darwin",
        "windows" => "windows",
        _ => return None,
    };
    match std::env::consts::ARCH {
        processor @ ("x86" | "x86_64" | "aarch64") => Some(format!("{processor}-{system}")),
        _ => None,
    }
}

/// The name of the library that is built with this program.
pub fn library() -> PathBuf {
    let (before, after) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    format!("{before}{IDENTIFIER}{after}").into()
}

/// The archive. The same inputs give the same bytes: no file has a time, and nothing is compressed.
///
/// # Errors
/// The archive would be too large, or FMI has no name for this platform.
pub fn archive(config: &[u8], cycle_ms: u32, library: &[u8]) -> io::Result<Vec<u8>> {
    let none = || {
        let (arch, system) = (std::env::consts::ARCH, std::env::consts::OS);
        io::Error::other(format!("FMI has no name for the platform {arch} {system}; Linux, macOS and Windows have one"))
    };
    let binary = format!("binaries/{}/{IDENTIFIER}{}", platform().ok_or_else(none)?, std::env::consts::DLL_SUFFIX);
    let page: &[u8] = include_bytes!("../README.md");
    let (mit, apache): (&[u8], &[u8]) = (include_bytes!("../../LICENSE-MIT"), include_bytes!("../../LICENSE-APACHE"));
    let xml = xml(config, cycle_ms)?;
    let files: [(&str, &[u8], u32); 7] = [
        ("modelDescription.xml", &xml, 0o644),
        (&binary, library, 0o755),
        ("resources/config.json", config, 0o644),
        ("documentation/index.html", PAGE.as_bytes(), 0o644),
        ("documentation/README.md", page, 0o644),
        ("documentation/licenses/LICENSE-MIT", mit, 0o644),
        ("documentation/licenses/LICENSE-APACHE", apache, 0o644),
    ];
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes, permissions) in files {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .last_modified_time(DateTime::default())
            .unix_permissions(permissions);
        zip.start_file(name, options)?;
        zip.write_all(bytes)?;
    }
    Ok(zip.finish()?.into_inner())
}

/// The page that FMI asks for.
const PAGE: &str = "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>On-board device</title>\n\
<p>The on-board device of an automatic train control system, as an FMI 3.0 co-simulation unit. Variables, rules and limits \
are in <a href=\"README.md\">README.md</a>, the configuration is in <code>resources/config.json</code>.</p>\n\
<p>Licence: <a href=\"licenses/LICENSE-MIT\">MIT</a> or <a href=\"licenses/LICENSE-APACHE\">Apache-2.0</a>.</p>\n</html>\n";
