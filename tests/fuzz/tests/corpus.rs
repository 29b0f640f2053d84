//! Every input of the repository that the fuzzers begin with, run once without a fuzzer: what they have found stays mended.

use std::fs;
use std::path::Path;
use std::thread;

/// Stack of a program's main thread, in which the fuzzers run the targets, bytes. That of a test is too small for them.
const STACK: usize = 8 << 20;

/// Runs the inputs of a target in its corpus, and the files of other folders of this package.
fn run_inputs_of(target: &'static str, other_folders: &'static [&str]) {
    let run = move || run_in_this_thread(target, other_folders);
    let thread = thread::Builder::new().stack_size(STACK).spawn(run).unwrap();
    assert!(thread.join().is_ok(), "the last input that is named breaks a property");
}

fn run_in_this_thread(target: &str, other_folders: &[&str]) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let corpus = format!("corpus/{target}");
    let target = fuzz::TARGETS.iter().find(|known| known.name == target).expect("a known target");
    let folders = [corpus.as_str()].into_iter().chain(other_folders.iter().copied());
    for folder in folders.map(|folder| root.join(folder)) {
        let entries = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{folder:?}: {error}"));
        let mut files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
        files.retain(|path| path.is_file());
        assert!(!files.is_empty(), "{folder:?} has no input");
        for file in files {
            println!("{}", file.display());
            (target.run)(&fs::read(&file).unwrap());
        }
    }
}

#[test]
fn bytes_to_the_line_reader() {
    run_inputs_of("wire", &[]);
}

#[test]
fn lines_to_a_device() {
    run_inputs_of("lines", &[]);
}

#[test]
fn samples_and_lines_to_a_station() {
    run_inputs_of("station", &[]);
}

#[test]
fn settings_and_readings() {
    run_inputs_of("settings", &[]);
}

#[test]
fn flash_of_the_settings() {
    run_inputs_of("flash", &[]);
}

#[test]
fn scenes() {
    run_inputs_of("scene", &["../../scenes"]);
}
