//! Session files and data sets for the tests.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What clock and computer say, the one file that differs between two runs.
const CLOCK: &str = "clock.json";

/// A new folder with this name, and in it a short session: section 4.3 with two materials, two trials a pair.
pub fn with_session(name: &str) -> (PathBuf, PathBuf) {
    let materials = r#"["copper", "stainless-steel", "granite", "abs"]"#;
    let short = [(materials, r#"["copper", "abs"]"#), ("repeat = 4", "repeat = 2")];
    with_ready(name, "p5-real-and-simulated", &short)
}

/// A new folder with this name, and in it a short session: the skin on samples of three materials, section 3.2.
pub fn with_skin_sensors(name: &str) -> (PathBuf, PathBuf) {
    let materials = r#"["copper", "bronze", "stainless-steel", "g10", "abs", "foam"]"#;
    let short = [(materials, r#"["copper", "abs", "foam"]"#)];
    with_ready(name, "p2-skin-temperature-fall", &short)
}

/// A new folder with this name, and in it a ready session with texts replaced.
pub fn with_ready(name: &str, ready: &str, replaced: &[(&str, &str)]) -> (PathBuf, PathBuf) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ignored = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let sessions = Path::new(env!("CARGO_MANIFEST_DIR")).join("sessions");
    let mut text = fs::read_to_string(sessions.join(format!("{ready}.toml"))).unwrap();
    for (from, to) in replaced {
        assert!(text.contains(from), "{ready} has no {from}");
        text = text.replace(from, to);
    }
    let session = folder.join("short.toml");
    fs::write(&session, text).unwrap();
    (folder, session)
}

/// All files of a data set by their paths in it, without what the clock says.
pub fn contents(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    add(root, root, &mut files);
    files
}

fn add(root: &Path, folder: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            add(root, &path, files);
        } else if path.file_name().is_some_and(|name| name != CLOCK) {
            let name = path.strip_prefix(root).unwrap().to_path_buf();
            files.insert(name, fs::read(&path).unwrap());
        }
    }
}

/// Asserts that two data sets have the same files with the same bytes.
pub fn assert_equal(one: &Path, other: &Path) {
    let (one, other) = (contents(one), contents(other));
    let names = |files: &BTreeMap<PathBuf, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other));
    for (name, bytes) in &one {
        assert!(bytes == &other[name], "{} differs", name.display());
    }
}
