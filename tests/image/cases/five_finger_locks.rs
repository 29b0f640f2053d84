//! How long the host's commands lock out the control tick of the image for five fingers, and how late it switches the
//! multiplexers then.

use std::iter;

use crc::{CRC_32_ISO_HDLC, Crc};
use documented_figures::assert_figure;
use stm32_emulator::{Firmware, FiveFingerBoard};
use thermal_sim::five_fingers::{FINGERS, FiveFingerEngine, run};
use thermal_sim::processor::FlashTiming;

use crate::five_fingers::{elf, five_layered_contacts, worlds};

/// Number of lines that restore the settings of a finger.
const SETTINGS_LINES: usize = 8;

/// Time in which every line is answered, ms.
const ANSWERED_IN_MS: usize = 300;

/// Lines to a finger that touches, in contact with an uploaded object. Each choice is made where it changes most: a material
/// after an object with a body, a finger after one of another tissue.
const IN_CONTACT: [&str; 67] = [
    "id",
    "board",
    "state",
    "cause",
    "self-test",
    "raw",
    "settings",
    "margins",
    "law",
    "law pi",
    "law pi-10hz",
    "law model",
    "finger",
    "finger thesis",
    "material copper",
    "finger mean",
    "finger mean-on-pad",
    "contact",
    "contact 0.9 61250 1000",
    "contact nominal",
    "material custom 0.17 700 2000 5 0.12",
    "object slab 3mm insulated",
    "object half-space",
    "object 20",
    "object room",
    "upload begin object 2 0.5",
    "upload row 0 20 40",
    "upload row 1 2 40",
    "upload commit",
    "material copper",
    "object slab 2mm film 10",
    "mode semi-infinite",
    "mode contact",
    "stream 20",
    "stream 0",
    "start",
    "calibrate room 25",
    "set tile 2.949416 0.058449 0.102339 0.101742 0.015895",
    "arm",
    "arm",
    "flux set 0.1192 2048 5 30",
    "flux",
    "finger thesis",
    "finger mean",
    "set flux 0.1 2000 4 20",
    "flux zero",
    "surface",
    "surface set 20 2 0.2",
    "set surface 36 1.5 0.15",
    "surface nominal",
    "person P01 0123456789abcdef0123456789abcdef01234567",
    "persons",
    "person P01",
    "person",
    "person enrol P01",
    "person none",
    "forget person P01",
    "flux none",
    "hold 30",
    "start",
    "arm",
    "tune",
    "tune result",
    "abort",
    "calibrate skin 33",
    "clear",
    "arm",
];

/// Points of the uploaded course: as many as a course may have, 1 ms apart and as steep as they may be, so that each tick
/// enters another segment.
const COURSE_POINTS: usize = 128;

/// Lines to an armed finger that has a course of 1-ms points.
const STIMULI: [&str; 19] = [
    "skin 33",
    "skin sensor",
    "events on",
    "trigger-out land,lift,start,end",
    "hold 30",
    "hold 31 0.01",
    "hold 30 100",
    "play now",
    "play now 1000",
    "hold 30.5 100",
    "play landing",
    "play trigger 1000 neutral",
    "play now 1000",
    "pulse 30 30.1 100 0.001 100",
    "pulse 30 30.1 100 0.001 100 now 1000",
    "pulse 30 31 0.01 3 0.01 landing",
    "hold 30 1",
    "trigger-out none",
    "events off",
];

/// Lines to a finger that has tripped, with a good bridge again.
const TRIPPED: [&str; 8] = ["state", "cause", "arm", "clear", "clear", "arm", "abort", "arm"];

/// A device for five fingers on which the scenes of five uploads have run.
struct Session {
    device: FiveFingerBoard,
    /// Longest time under the lock so far, us, and its line.
    longest_lock: (f64, String),
}

impl Session {
    fn after_uploads(flash: FlashTiming) -> Self {
        let scenes = five_layered_contacts().map(|mut scene| {
            scene.chip.flash = flash;
            scene
        });
        let image = Firmware::from_file(elf()).expect("an image for this chip");
        let mut device = FiveFingerBoard::new(&image, worlds(&scenes)).expect("the image starts");
        run(&scenes, &mut device, |_| ()).expect("the image runs to the end");
        let mut session = Self { device, longest_lock: (0.0, String::new()) };
        for finger in 0..FINGERS {
            session.ask(finger, "stream 0");
        }
        session
    }

    fn advance(&mut self, finger: usize) {
        self.device.run_to(finger).expect("the image runs");
        let legs = self.device.legs(finger);
        self.device.world(finger).step(legs);
    }

    fn wait_ms(&mut self, ms: usize) {
        for _ in 0..ms {
            (0..FINGERS).for_each(|finger| self.advance(finger));
        }
    }

    /// Sends a line `ps` after a boundary of the first finger, and returns its answer.
    fn ask_at(&mut self, ps: u64, finger: usize, line: &str) -> String {
        self.device.reset_cost();
        self.advance(0);
        self.device.run_beyond_boundary(ps).expect("runs");
        self.device.send(format!("@{finger} {line}\n").as_bytes());
        (1..FINGERS).for_each(|finger| self.advance(finger));
        let answer = self.answer_of(finger);
        let lock_us = self.device.longest_lock_us();
        println!("{lock_us:.2} us: {line} < {answer}");
        if lock_us > self.longest_lock.0 {
            self.longest_lock = (lock_us, line.to_owned());
        }
        answer
    }

    /// Runs the device until a finger has answered.
    fn answer_of(&mut self, finger: usize) -> String {
        let answers = [format!("@{finger} ok"), format!("@{finger} err")];
        let mut received = Vec::new();
        for _ in 0..ANSWERED_IN_MS {
            self.wait_ms(1);
            self.device.receive(&mut received);
            let text = String::from_utf8_lossy(&received);
            let mut lines = text.split_inclusive('\n').filter(|line| line.ends_with('\n'));
            if let Some(line) =
                lines.find(|line| answers.iter().any(|answer| line.starts_with(answer)))
            {
                return line.trim_end().to_owned();
            }
        }
        panic!("finger {finger} has not answered")
    }

    fn ask(&mut self, finger: usize, line: &str) -> String {
        self.ask_at(0, finger, line)
    }

    /// Sends these lines to the first finger; `upload commit` gets its checksum.
    fn ask_with_uploads(&mut self, lines: impl IntoIterator<Item = String>) {
        let mut uploaded = String::new();
        for mut line in lines {
            if line.starts_with("upload begin") {
                uploaded.clear();
            }
            if line == "upload commit" {
                let checksum = Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(uploaded.as_bytes());
                line += &format!(" {checksum:08x}");
            }
            if line.starts_with("upload") {
                uploaded += &format!("{line}\n");
            }
            self.ask(0, &line);
        }
    }

    /// Sends all commands of docs/protocol.md, in the states in which they do most. Missing are only `save` and `forget`, which
    /// need every bridge off, `checksum`, which no finger executes, and the rows of a complete identification, which takes half
    /// a minute.
    fn ask_everything(&mut self) {
        self.ask_with_uploads(IN_CONTACT.map(str::to_owned));
        let rows = (0..COURSE_POINTS).map(|row| {
            let celsius = ["30", "30.1"][row % 2];
            format!("upload row {row} {:.3} {celsius}", 1e-3 * row as f64)
        });
        let begin = format!("upload begin course {COURSE_POINTS} absolute");
        let upload = iter::once(begin).chain(rows);
        self.ask_with_uploads(upload.chain(["upload commit".to_owned()]));
        for line in STIMULI {
            assert!(self.ask(0, line).starts_with("@0 ok"), "{line}");
        }
        self.device.world(3).set_latch();
        self.wait_ms(5);
        TRIPPED[..3].iter().for_each(|line| drop(self.ask(3, line)));
        self.device.world(3).connect_supply();
        self.wait_ms(100);
        TRIPPED[3..].iter().for_each(|line| drop(self.ask(3, line)));
        self.device.world(4).set_force_and_faults(0.0, iter::empty());
        self.wait_ms(100);
        self.ask(4, "arm");
        self.wait_ms(600);
        self.ask(4, "calibrate room 25");
        let settings: Vec<_> =
            (1..=SETTINGS_LINES).map(|line| self.ask(4, &format!("settings {line}"))).collect();
        self.ask(4, "hold 30");
        for line in settings {
            assert!(self.ask(4, "tune").starts_with("@4 ok"));
            let line = line.strip_prefix("@4 ok ").expect("settings");
            assert!(self.ask(4, line).starts_with("@4 ok"));
        }
    }
}

/// While a command is executed, the tick of the next finger waits, which must switch the multiplexers within 11.1 us. So
/// [`switches_in_time`] needs the longest command, which this test finds.
#[test]
fn commands_lock_the_tick_out_briefly() {
    let longest_locks = FLASH_TIMINGS.map(|flash| {
        let mut session = Session::after_uploads(flash);
        session.ask_everything();
        session.longest_lock
    });
    println!("{longest_locks:?}");
    // With wait states, where the code lies decides between commands that are a few percent apart.
    let [(us, line), ..] = &longest_locks;
    assert_eq!(line, LONGEST, "the longest command, {us} us");
    let keys = ["", "_art", "_off"].map(|timing| format!("five_fingers.lock{timing}"));
    for ((us, _), key) in longest_locks.iter().zip(keys) {
        assert_figure(&key, *us);
    }
}

const FLASH_TIMINGS: [FlashTiming; 3] =
    [FlashTiming::Ideal, FlashTiming::Accelerated, FlashTiming::Unaccelerated];

/// The command that locks longest if the flash needs no wait states.
const LONGEST: &str = "finger thesis";

/// Sends the longest command at times 0.5 us apart over one turn, so that one of them begins to lock right before a finger's
/// last scan ends.
fn switches_in_time(flash: FlashTiming) -> f64 {
    const STEP_PS: u64 = 500_000;
    const TURN_PS: u64 = 200_000_000;
    let mut session = Session::after_uploads(flash);
    session.device.world(4).set_force_and_faults(0.0, iter::empty());
    session.wait_ms(100);
    session.ask(4, "arm");
    for ps in (0..TURN_PS).step_by(STEP_PS as usize) {
        assert!(session.ask_at(ps, 4, LONGEST).starts_with("@4 ok"));
    }
    assert!(session.ask(0, "state").contains("fault=-"));
    session.device.longest_switch_us()
}

/// The program has the 11.1 us of one scan to switch the multiplexers after the block of a finger.
#[test]
fn the_multiplexers_are_switched_in_time_behind_the_longest_command() {
    for (flash, key) in [
        (FlashTiming::Ideal, "five_fingers.switch"),
        (FlashTiming::Accelerated, "five_fingers.switch_art"),
        (FlashTiming::Unaccelerated, "five_fingers.switch_off"),
    ] {
        assert_figure(key, switches_in_time(flash));
    }
}
