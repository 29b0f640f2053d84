//! Kinds of defects and interruptions.

use crate::line::{Change, Defect, Lines, Which};

/// A signal to the client.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// The terminal's Ctrl-C.
    Int,
    Term,
    Hup,
    /// The process stands still for 4 s, as in a computer that sleeps.
    Stop,
    /// Nothing can be done about it; the device has its guard.
    Kill,
}

/// One kind of trouble.
#[derive(Clone, Debug)]
pub struct Kind {
    pub name: String,
    pub defect: Defect,
    /// Sent at a moment that the seed draws.
    pub signal: Option<Signal>,
    pub seed: u64,
    /// Whether the line may keep a client from finding out that the bridge is off, so that it must call for the emergency stop.
    pub hides_the_bridge: bool,
    /// Whether the line keeps a client from switching the bridge off at all; the device does it then.
    pub is_cut: bool,
    /// Whether telemetry no longer comes or is no longer understood, which whoever watches the device must be told.
    pub hides_telemetry: bool,
}

/// The commands whose answers are lost or late.
const COMMANDS: [&str; 17] = [
    "checksum off",
    "checksum on",
    "synchronize",
    "id",
    "state",
    "stream",
    "stream 0",
    "events",
    "arm",
    "abort",
    "flux",
    "settings",
    "upload",
    "play",
    "board",
    "law",
    "hold",
];

/// Time from the client's first line on by which it watches a driven device, ms.
const WATCHING_MS: u64 = 2000;

/// All kinds.
pub fn all() -> Vec<Kind> {
    use Change::{
        AnsweredInPlaceOfTheDevice, BitChanged, Cut, Doubled, Late, Lost, Rewritten, Swapped,
    };
    use Lines::{AnswerTo, Answers, Command, Commands, FromDevice, Telemetry};
    use Which::{After, Every, First, OneIn};

    let mut kinds = vec![kind("none", Defect::None)];
    for command in COMMANDS {
        let hides = matches!(command, "synchronize" | "id" | "state" | "abort");
        let changed = |which, change| Defect::Changed(AnswerTo(command), which, change);
        kinds.push(kind(format!("answer to `{command}` lost once"), changed(First, Lost)));
        kinds.push(kind(
            format!("answer to `{command}` 2.2 s late once"),
            changed(First, Late(2200)),
        ));
        let lost = kind(format!("each answer to `{command}` lost"), changed(Every, Lost));
        kinds.push(Kind { hides_the_bridge: hides, ..lost });
    }
    let changed = |lines, which, change| Defect::Changed(lines, which, change);
    let hides = |name: &str, defect| Kind { hides_the_bridge: true, ..kind(name, defect) };
    let cut =
        |name: &str, defect| Kind { hides_the_bridge: true, is_cut: true, ..kind(name, defect) };
    let watched = |name: &str, change| Kind {
        hides_telemetry: true,
        ..kind(name, changed(Telemetry, After(WATCHING_MS), change))
    };
    kinds.extend([
        hides("`abort` lost once", changed(Command("abort"), First, Lost)),
        cut("each `abort` lost", changed(Command("abort"), Every, Lost)),
        cut(
            "abort lies: `ok`, and the device goes on",
            changed(Command("abort"), Every, AnsweredInPlaceOfTheDevice("ok")),
        ),
        cut(
            "`abort` refused",
            changed(Command("abort"), Every, AnsweredInPlaceOfTheDevice("err not now")),
        ),
        kind("`arm` lost once", changed(Command("arm"), First, Lost)),
        kind("each answer doubled", changed(Answers, Every, Doubled)),
        kind("each command doubled", changed(Commands, Every, Doubled)),
        hides("each answer 0.3 s late", changed(Answers, Every, Late(300))),
        hides("each answer 1.9 s late", changed(Answers, Every, Late(1900))),
        hides("each answer 2.2 s late", changed(Answers, Every, Late(2200))),
        hides("each answer half", changed(Answers, Every, Cut)),
        hides("each fifth line of the device lost", changed(FromDevice, OneIn(5), Lost)),
        hides("each fifth command lost", changed(Commands, OneIn(5), Lost)),
        hides(
            "one bit changed in each fifth line of the device",
            changed(FromDevice, OneIn(5), BitChanged),
        ),
        hides("one bit changed in each fifth command", changed(Commands, OneIn(5), BitChanged)),
        hides("each fifth line of the device half", changed(FromDevice, OneIn(5), Cut)),
        hides(
            "each third line of the device after the next",
            changed(FromDevice, OneIn(3), Swapped),
        ),
        hides("stray `ok` each 0.3 s", Defect::Stray("ok", 300)),
        hides("stray `ok` each s", Defect::Stray("ok", 1000)),
        hides("stray `err x` each 0.3 s", Defect::Stray("err x", 300)),
        hides("stray `ok T:20` each 0.5 s", Defect::Stray("ok T:20", 500)),
        kind(
            "stray telemetry of another tick each 0.3 s",
            Defect::Stray("T 7 armed - - - - - - 0 0 0 -", 300),
        ),
        kind(
            "stray control characters each 0.3 s",
            Defect::Stray("\u{1b}]0;x\u{7}\u{fffd}\u{0}", 300),
        ),
        hides(
            "stray `err` with control characters each 0.3 s",
            Defect::Stray("err \u{1b}]0;x\u{7}", 300),
        ),
        watched("readings `nan`", Rewritten(|line| with_word(line, 4, "nan"))),
        watched("readings with two spaces between", Rewritten(|line| line.replace(' ', "  "))),
        watched("a state that is not known", Rewritten(|line| with_word(line, 2, "warming"))),
        watched("telemetry ends", Lost),
        // An answer that follows is in the same line.
        Kind { hides_the_bridge: true, ..watched("telemetry half", Cut) },
        kind("telemetry doubled", changed(Telemetry, Every, Doubled)),
        kind(
            "ticks go back",
            changed(Telemetry, OneIn(7), Rewritten(|line| with_word(line, 1, "3"))),
        ),
        cut("half-open from 0.05 s on", Defect::HalfOpen(50)),
        cut("half-open from 2.5 s on", Defect::HalfOpen(2500)),
        cut("closed at 0 s", Defect::Closed(0)),
        cut("closed at 0.1 s", Defect::Closed(100)),
        cut("closed at 0.5 s", Defect::Closed(500)),
        cut("closed at 1.5 s", Defect::Closed(1500)),
        cut("closed at 2.5 s", Defect::Closed(2500)),
        cut("closed at `abort`", Defect::ClosedAt("abort")),
        cut("closed at `arm`", Defect::ClosedAt("arm")),
        cut("closed at `play`", Defect::ClosedAt("play")),
        hides(
            "each `id` says two fingers",
            changed(
                AnswerTo("id"),
                Every,
                Rewritten(|line| line.replace("fingers=1", "fingers=2")),
            ),
        ),
        kind(
            "first `id` says no finger",
            changed(
                AnswerTo("id"),
                First,
                Rewritten(|line| line.replace("fingers=1", "fingers=0")),
            ),
        ),
        kind(
            "first `id` says 4e9 fingers",
            changed(
                AnswerTo("id"),
                First,
                Rewritten(|line| line.replace("fingers=1", "fingers=4000000000")),
            ),
        ),
    ]);
    for (signal, name) in [
        (Signal::Int, "SIGINT"),
        (Signal::Term, "SIGTERM"),
        (Signal::Hup, "SIGHUP"),
        (Signal::Stop, "SIGSTOP for 4 s"),
        (Signal::Kill, "SIGKILL"),
    ] {
        for seed in 0..4 {
            let name = format!("{name} at a moment of seed {seed}");
            kinds.push(Kind { signal: Some(signal), seed, ..kind(name, Defect::None) });
        }
    }
    kinds
}

fn kind(name: impl Into<String>, defect: Defect) -> Kind {
    Kind {
        name: name.into(),
        defect,
        signal: None,
        seed: 1,
        hides_the_bridge: false,
        is_cut: false,
        hides_telemetry: false,
    }
}

impl Kind {
    /// Whether it leaves the number of bytes as it is, which the ends of a line in step count.
    pub const fn keeps_bytes(&self) -> bool {
        match self.defect {
            Defect::None | Defect::HalfOpen(_) | Defect::Closed(_) | Defect::ClosedAt(_) => true,
            Defect::Changed(_, _, change) => matches!(change, Change::Lost | Change::BitChanged),
            Defect::Stray(..) => false,
        }
    }
}

/// A line with another word at a place, counted from 0.
fn with_word(line: &str, place: usize, word: &str) -> String {
    let mut words: Vec<_> = line.split(' ').collect();
    if let Some(old) = words.get_mut(place) {
        *old = word;
    }
    words.join(" ")
}
