//! Each detector of the guard removed in turn: the fault-injection matrix must notice.
//!
//! A copy of the sources, in which one line is changed, is built and runs the rows that the detector is for, natively or, if
//! it is the board's, as an image. A mutation that no row notices is a hole in the matrix.
use std::ffi::OsString;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};

use crate::process::{Invocation, workspace};

/// A detector that no longer detects.
struct Mutation {
    /// Its name.
    detector: &'static str,
    /// Where it is.
    file: &'static str,
    /// The text that is changed, which stands there once.
    from: &'static str,
    /// What stands there instead.
    to: &'static str,
    /// Kinds of the faults that it is for.
    only: &'static [&'static str],
    /// What runs them: the board's detectors are in the image only.
    engine: &'static str,
}

const fn mutation(
    detector: &'static str,
    file: &'static str,
    from: &'static str,
    to: &'static str,
    only: &'static [&'static str],
) -> Mutation {
    Mutation {
        detector,
        file,
        from,
        to,
        only,
        engine: "native",
    }
}

impl Mutation {
    /// Of a detector that only the image has.
    const fn of_image(self) -> Self {
        Self {
            engine: "image",
            ..self
        }
    }
}

const LIMITS: &str = "src/guard/limits.rs";
const JUMP: &str = "src/guard/jump.rs";
const WATCH: &str = "src/guard/watch.rs";
const SELF_TEST: &str = "src/guard/self_test.rs";
const THERMISTOR: &str = "src/sense/thermistor.rs";

const MUTATIONS: [Mutation; 33] = [
    mutation(
        "excitation",
        LIMITS,
        "Err(SensorFault::Short); 5]",
        "Err(SensorFault::Open); 5]",
        &["reference-off"],
    ),
    mutation(
        "open thermistor",
        THERMISTOR,
        "SHORT_BELOW..=OPEN_ABOVE => Ok(()),",
        "SHORT_BELOW..=u16::MAX => Ok(()),",
        &["thermistor-open"],
    ),
    mutation(
        "shorted thermistor",
        THERMISTOR,
        "..SHORT_BELOW => Err(SensorFault::Short),",
        "..SHORT_BELOW => Ok(()),",
        &["thermistor-short"],
    ),
    mutation(
        "force sensor",
        "src/sense/force.rs",
        "if sum < self.broken_below || sum > TOP {",
        "if sum < self.broken_below && sum > TOP {",
        &["force-open"],
    ),
    mutation(
        "display hot",
        LIMITS,
        "> DISPLAY_HOTTEST {",
        "> Celsius::MAX {",
        &["thermistor-drift"],
    ),
    mutation(
        "display cold",
        LIMITS,
        "< DISPLAY_COLDEST {",
        "< Celsius::MIN {",
        &["thermistor-drift"],
    ),
    mutation(
        "sink hot",
        LIMITS,
        "sound.sink > SINK_HOTTEST",
        "sound.sink > Celsius::MAX",
        &["chiller-off"],
    ),
    mutation(
        "over-current",
        LIMITS,
        "limit.saturating_add(CURRENT_MARGIN)",
        "Current::MAX",
        &["mirror-stuck"],
    ),
    mutation(
        "display jump",
        JUMP,
        "if jumped(sound.display, display) {",
        "if jumped(display, display) {",
        &["thermistor-offset"],
    ),
    mutation(
        "check jump",
        JUMP,
        "if jumped(sound.check, check) {",
        "if jumped(check, check) {",
        &["thermistor-offset"],
    ),
    mutation(
        "sink jump",
        JUMP,
        "if jumped(sound.sink, sink) {",
        "if jumped(sink, sink) {",
        &["thermistor-offset"],
    ),
    mutation(
        "apart",
        WATCH,
        "named(self.apart.has(apart, APART_TICKS)",
        "named(self.apart.has(false, APART_TICKS)",
        &["thermistor-drift"],
    ),
    mutation(
        "unlike model",
        WATCH,
        "self.unlike.has(unlike_model, UNLIKE_TICKS)",
        "self.unlike.has(false, UNLIKE_TICKS)",
        &["module-weak"],
    ),
    mutation(
        "room",
        WATCH,
        "named(self.room.has(room, ROOM_TICKS)",
        "named(self.room.has(false, ROOM_TICKS)",
        &["thermistor-drift"],
    ),
    mutation(
        "host silent",
        WATCH,
        "self.silent_ticks >= SILENT_TICKS",
        "self.silent_ticks > u16::MAX - 1",
        &["host-silent"],
    ),
    mutation(
        "dose",
        WATCH,
        "self.dose.check(|| both.into_iter().flatten().max())",
        "self.dose.check(|| None)",
        &["host-line"],
    ),
    mutation(
        "current high",
        "src/guard/electrical.rs",
        "has(high || low, TICKS)",
        "has(low, TICKS)",
        &["mirror-stuck"],
    ),
    mutation(
        "current low",
        "src/guard/electrical.rs",
        "has(high || low, TICKS)",
        "has(high, TICKS)",
        &["leg-open"],
    ),
    mutation(
        "frozen",
        "src/guard/frozen.rs",
        "if ticks >= FROZEN_TICKS {",
        "if ticks > FROZEN_TICKS + 200 {",
        &["adc-stuck"],
    ),
    mutation(
        "response",
        "src/guard/response.rs",
        "const BACK: Celsius = Celsius::lit(\"2.5\");",
        "const BACK: Celsius = Celsius::lit(\"90\");",
        &["polarity-swapped"],
    ),
    mutation(
        "fault line",
        "src/station.rs",
        "let bridge = if pulled {",
        "let bridge = if pulled && self.tick == 0 {",
        &["bridge-shorted"],
    ),
    mutation(
        "self-test",
        "src/station.rs",
        "self.state = State::SelfTest;",
        "self.state = State::Armed;",
        &["comparator-dead"],
    ),
    mutation(
        "comparator test",
        SELF_TEST,
        "&& cut != testing {",
        "&& cut && !testing {",
        &["comparator-dead"],
    ),
    mutation(
        "polarity test",
        SELF_TEST,
        "if fell < -i64::from(LEAST.to_bits()) {",
        "if fell < -i64::from(Celsius::MAX.to_bits()) {",
        &["polarity-swapped"],
    ),
    mutation(
        "response test",
        SELF_TEST,
        "if !(i64::from(LEAST.to_bits())..=",
        "if !(i64::MIN..=",
        &["module-weak"],
    ),
    mutation(
        "current test",
        SELF_TEST,
        "if mean < i64::from(LEAST_A.to_bits()) {",
        "if mean < 0 {",
        &["mirror-stuck"],
    ),
    mutation(
        "pace",
        "src/board/nucleo_f446re/timekeeper.rs",
        "if !self.pace.keeps(SYST::get_current()) {",
        "if !self.pace.keeps(SYST::get_current()) && FINGERS > 9 {",
        &["register-bit"],
    )
    .of_image(),
    mutation(
        "clocks",
        "src/board/nucleo_f446re/timekeeper.rs",
        "if clocks() != self.clocks {",
        "if clocks() != self.clocks && FINGERS > 9 {",
        &["register-bit"],
    )
    .of_image(),
    mutation(
        "unasked reset",
        "src/board/nucleo_f446re/reset.rs",
        "Self::Software | Self::Other => Some(Fault::UnaskedReset),",
        "Self::Software | Self::Other => None,",
        &["software-reset"],
    )
    .of_image(),
    mutation(
        "roll-call",
        "src/board/vigil.rs",
        "const ALL: u8 = Task::Tick as u8 | Task::Host as u8;",
        "const ALL: u8 = Task::Tick as u8;",
        &["register-bit"],
    )
    .of_image(),
    mutation(
        "stack guard",
        "src/board/nucleo_f446re/stack.rs",
        ".any(|word| word.load(Ordering::Relaxed) != UNTOUCHED)",
        ".all(|word| word.load(Ordering::Relaxed) != UNTOUCHED)",
        &["ram-bit"],
    )
    .of_image(),
    mutation(
        "window watchdog",
        "src/board/nucleo_f446re/window.rs",
        "w.wdga().enabled()",
        "w.wdga().disabled()",
        &["hung-core"],
    )
    .of_image(),
    mutation(
        "clock security",
        "src/board/nucleo_f446re/mod.rs",
        "w.csson().on()",
        "w.csson().off()",
        &["hse-stopped"],
    )
    .of_image(),
];

/// Folder of the copy and of what is built from it.
const FOLDER: &str = "target/mutations";
/// What is built for each mutation runs a few rows only.
const QUICKLY_BUILT: [&str; 3] = [
    "profile.release.lto = \"off\"",
    "profile.release.codegen-units = 16",
    "profile.release.incremental = true",
];
/// What of the workspace is copied; not Cargo's configuration, which is read from the folders above, too, and would add its flags
/// twice.
const COPIED: [&str; 12] = [
    "Cargo.toml",
    "Cargo.lock",
    "rust-toolchain.toml",
    "build.rs",
    "memory.x",
    "README.md",
    "src",
    "model",
    "hil-sim",
    "xtask",
    "tests",
    "scenes",
];

/// Runs every mutation; an error names those that no row notices.
pub fn run() -> Result<()> {
    let copy = workspace().join(FOLDER).join("sources");
    if copy.exists() {
        fs::remove_dir_all(&copy).with_context(|| copy.display().to_string())?;
    }
    fs::create_dir_all(&copy).with_context(|| copy.display().to_string())?;
    for name in COPIED {
        let from = workspace().join(name);
        if from.exists() {
            copied(&from, &copy.join(name))?;
        }
    }
    let hil_sim = |command: &str| {
        let mut line: Vec<OsString> = [
            command,
            "--release",
            "--package",
            "hil-sim",
            "--manifest-path",
        ]
        .map(OsString::from)
        .into();
        line.push(copy.join("Cargo.toml").into());
        line.push("--target-dir".into());
        line.push(workspace().join(FOLDER).join("target").into());
        for setting in QUICKLY_BUILT {
            line.extend(["--config", setting].map(OsString::from));
        }
        line
    };
    let matrix = |engine: &str, only: &[&str]| {
        let mut line = hil_sim("run");
        line.extend(
            [
                "--",
                "faults",
                "--engine",
                engine,
                "--moments",
                "4",
                "--only",
            ]
            .map(OsString::from),
        );
        line.extend(only.iter().map(OsString::from));
        Invocation::cargo(line)
    };
    for engine in ["native", "image"] {
        let of_engine = MUTATIONS
            .iter()
            .filter(|mutation| mutation.engine == engine);
        let mut kinds: Vec<_> = of_engine
            .flat_map(|mutation| mutation.only)
            .copied()
            .collect();
        kinds.sort_unstable();
        kinds.dedup();
        matrix(engine, &kinds)
            .run_to_stderr()
            .context("the sources as they are must pass")?;
    }
    let mut unnoticed = Vec::new();
    for mutation in &MUTATIONS {
        let path = copy.join(mutation.file);
        let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        fs::write(&path, mutated(mutation, &text)?)?;
        // What does not build is no mutation.
        Invocation::cargo(hil_sim("build")).run_to_stderr()?;
        if mutation.engine == "image" {
            let manifest = copy.join("Cargo.toml").into();
            let line = ["run", "--package", "xtask", "--manifest-path"].map(OsString::from);
            let firmware = [manifest, "--".into(), "firmware".into()];
            Invocation::cargo(line.into_iter().chain(firmware)).run_to_stderr()?;
        }
        let noticed = matrix(mutation.engine, mutation.only)
            .run_to_stderr()
            .is_err();
        fs::write(&path, text)?;
        println!(
            "{:16} {}",
            mutation.detector,
            if noticed { "noticed" } else { "NOT noticed" }
        );
        if !noticed {
            unnoticed.push(mutation.detector);
        }
    }
    if !unnoticed.is_empty() {
        bail!(
            "no row notices that these are gone: {}",
            unnoticed.join(", ")
        );
    }
    Ok(())
}

/// The text without the detector.
fn mutated(mutation: &Mutation, text: &str) -> Result<String> {
    let found = text.matches(mutation.from).count();
    ensure!(
        found == 1,
        "{}: `{}` stands {found} times in {}; a mutation needs it once",
        mutation.detector,
        mutation.from,
        mutation.file
    );
    Ok(text.replacen(mutation.from, mutation.to, 1))
}

fn copied(from: &Path, to: &Path) -> Result<()> {
    if !from.is_dir() {
        fs::copy(from, to).with_context(|| from.display().to_string())?;
        return Ok(());
    }
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        if entry.file_name() != "target" {
            copied(&entry.path(), &to.join(entry.file_name()))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mutation_fits_the_sources_as_they_are() {
        for mutation in &MUTATIONS {
            let text = fs::read_to_string(workspace().join(mutation.file)).expect(mutation.file);
            let changed = mutated(mutation, &text).expect(mutation.detector);
            assert_ne!(changed, text, "{}", mutation.detector);
        }
    }
}
