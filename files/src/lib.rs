//! Writes a file so that nothing half-written ever has its name. For every command that has an `-o`.
//!
//! # In the house
//!
//! Uses no other crate of the house. Used by `atc-fmi`, `atc-oracle`, `atc-waveform`. Begin with [`write()`].

use std::fs;
use std::io::{self, Write as _};
use std::path::Path;

/// Writes a file. Over a plain file goes a new one that was written beside it, with the same permissions; a link stays one, and what it leads
/// to is replaced; what is no plain file, such as a pipe or a device, is written to as it is.
///
/// # Errors
/// The file cannot be written, is a folder, or is there and read-only.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    match fs::metadata(path) {
        Ok(there) if there.is_dir() => Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder")),
        Ok(there) if !there.is_file() => through(path, bytes),
        Ok(there) if there.permissions().readonly() => {
            Err(io::Error::new(io::ErrorKind::PermissionDenied, "it is there and read-only"))
        }
        Ok(_) => fs::canonicalize(path).and_then(|file| replace(&file, bytes)),
        // A link that leads nowhere yet.
        Err(_) if path.is_symlink() => through(path, bytes),
        Err(_) => replace(path, bytes),
    }
}

/// Writes a folder with these files: all of it, or nothing. It is made anew, or was there and empty.
///
/// # Errors
/// There is something else, or the folder cannot be written.
pub fn write_folder(path: &Path, files: &[(String, Vec<u8>)]) -> io::Result<()> {
    let refused = |kind, what| Err(io::Error::new(kind, what));
    let there = path.is_dir();
    if there && fs::read_dir(path)?.next().is_some() {
        return refused(
            io::ErrorKind::AlreadyExists,
            "it is there and not empty; name a new folder, or empty this one",
        );
    }
    if !there && path.exists() {
        return refused(io::ErrorKind::AlreadyExists, "it is there and no folder; name a folder");
    }
    let beside = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(beside)?;
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As for any new folder: the umask takes away what it takes away.
        builder.permissions(fs::Permissions::from_mode(0o777));
    }
    let new = builder.tempdir_in(beside).map_err(|error| no_room(beside, &error))?;
    for (name, bytes) in files {
        fs::write(new.path().join(name), bytes)?;
    }
    if there {
        fs::remove_dir(path)?;
    }
    fs::rename(new.path(), path)
}

/// The new one that is written first cannot be made: its name says nothing to anybody.
fn no_room(folder: &Path, error: &io::Error) -> io::Error {
    io::Error::new(
        error.kind(),
        format!("nothing new can be made in the folder {}: {}", folder.display(), error.kind()),
    )
}

fn through(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = fs::OpenOptions::new().write(true).create(true).truncate(true).open(path)?;
    file.write_all(bytes)?;
    file.flush()
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As for any new file: the umask takes away what it takes away. A file that was there keeps what it had.
        let any = || fs::Permissions::from_mode(0o666);
        builder.permissions(fs::metadata(path).map_or_else(|_| any(), |old| old.permissions()));
    }
    let mut file = builder.tempfile_in(folder).map_err(|error| no_room(folder, &error))?;
    file.write_all(bytes)?;
    file.persist(path).map(drop).map_err(|error| error.error)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::{write, write_folder};

    /// What is missing is said of the folder, and not of a file that nobody has named.
    #[test]
    fn a_folder_that_is_not_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let error = write(&folder.path().join("none/file"), b"text").expect_err("there is no such folder");
        let said = error.to_string();
        assert!(said.contains("nothing new can be made in the folder") && said.contains("none"), "{said}");
        // Only the folder of this test has such a name.
        assert!(said.ends_with("entity not found") && said.matches(".tmp").count() == 1, "{said}");
    }

    #[test]
    fn a_folder_is_written_whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a folder");
        let there = |name: &str| folder.path().join(name);
        let file = |name: &str| (name.to_owned(), b"text".to_vec());
        write_folder(&there("a/b"), &[file("one"), file("two")]).expect("written");
        assert_eq!(fs::read_dir(there("a/b")).expect("there").count(), 2);
        let again = write_folder(&there("a/b"), &[file("three")]).expect_err("it is not empty");
        assert!(again.to_string().contains("not empty") && !there("a/b/three").exists(), "{again}");
        fs::create_dir(there("empty")).expect("made");
        write_folder(&there("empty"), &[file("one")]).expect("written");
        assert!(there("empty/one").exists());
        fs::write(there("file"), "").expect("written");
        assert!(write_folder(&there("file"), &[]).expect_err("a file").to_string().contains("no folder"));
        // A name that no file system takes.
        write_folder(&there("long"), &[file("one"), file(&"x".repeat(300))]).expect_err("too long");
        assert!(!there("long").exists());
        assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 3, "nothing is left lying");
    }

    #[test]
    fn a_file_is_replaced_and_nothing_else_is() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        for text in [b"one", b"two"] {
            write(&file, text).expect("it is written");
            assert_eq!(fs::read(&file).expect("it is there"), text);
        }
        assert!(write(folder.path(), b"one").is_err());
        assert!(write(&folder.path().join("none/file"), b"one").is_err());
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing is left beside it");
    }

    #[cfg(unix)]
    #[test]
    fn links_devices_and_permissions_stay() {
        use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _, symlink};
        let folder = tempfile::tempdir().expect("a folder");
        let [file, link, device] = ["file", "link", "null"].map(|name| folder.path().join(name));
        fs::write(&file, "one").expect("it is written");
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).expect("they are set");
        symlink(&file, &link).expect("a link");
        write(&link, b"two").expect("it is written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).expect("it is there"), b"two");
        assert_eq!(fs::metadata(&file).expect("it is there").permissions().mode() & 0o777, 0o640);
        symlink("/dev/null", &device).expect("a link");
        write(&device, b"three").expect("it is written");
        assert!(fs::metadata("/dev/null").expect("it is there").file_type().is_char_device());
        fs::set_permissions(&file, fs::Permissions::from_mode(0o440)).expect("they are set");
        assert!(write(&file, b"four").is_err());
        assert_eq!(fs::read(&file).expect("it is there"), b"two");
    }
}
