//! How long the host's commands lock out the control tick of the image for five fingers.

use stm32_emulator::{Firmware, FiveFingerBoard};
use thermal_sim::five_fingers::{FINGERS, FiveFingerEngine, run};
use thermal_sim::processor::FlashTiming;

use crate::five_fingers::{elf, five_layered_contacts, worlds};

struct Session { hand: FiveFingerBoard, worst: f64 }
impl Session {
fn turn(&mut self) {
    let hand = &mut self.hand;
    for finger in 0..FINGERS {
        hand.run_to(finger).expect("runs");
        let legs = hand.legs(finger);
        hand.world(finger).step(legs);
    }
}
fn wait(&mut self, ms: usize) { for i in 0..ms { if i % 1000 == 999 { self.hand.send(b"\n"); } self.turn(); } let mut x = vec![]; self.hand.receive(&mut x); }
fn ask(&mut self, finger: usize, line: &str) -> String {
        self.hand.reset_cost();
        self.hand.send(format!("@{finger} {line}\n").as_bytes());
        let mut out = vec![];
        let prefix = format!("@{finger} ");
        for n in 0..300 {
            self.turn();
            self.hand.receive(&mut out);
            let text = String::from_utf8_lossy(&out).into_owned();
            if n > 4 && text.ends_with('\n') && let Some(a) = text.lines().find(|l| l.starts_with(&(prefix.clone() + "ok")) || l.starts_with(&(prefix.clone() + "err"))) {
                let us = self.hand.longest_lock_us();
                self.worst = self.worst.max(us);
                println!("{us:8.2} us  @{finger} {line:30} {}", &a[..a.len().min(70)]);
                return a[3..].to_owned();
            }
        }
        panic!("no answer to {line}");
}
}

fn each(flash: FlashTiming) {
    let scenes = five_layered_contacts().map(|mut scene| {
        scene.chip.flash = flash;
        scene
    });
    let image = Firmware::from_file(elf()).expect("an image for this chip");
    let mut hand = FiveFingerBoard::new(&image, worlds(&scenes)).expect("the image starts");
    run(&scenes, &mut hand, |_| ()).expect("set-up");
    println!("{}: in scene lock {:.2} us switch {:.2}", flash.name(), hand.longest_lock_us(), hand.longest_switch_us());
    let mut s = Session { hand, worst: 0.0 };
    let up = ["upload begin object 2 0.5", "upload row 0 20 40", "upload row 1 2 40"];
    let sum = |lines: &[&str]| {
        let mut text = String::new();
        for l in lines { text += l; text += "\n"; }
        format!("upload commit {:08x}", crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(text.as_bytes()))
    };
    let commit = sum(&up);
    let lines: Vec<&str> = vec![
        "state", "cause", "self-test", "raw", "board", "id", "law", "law pi", "law pi-10hz", "law model", "finger", "finger thesis", "material copper",
        "finger mean", "finger mean-on-pad", "finger mean", "material granite", "object slab 3mm insulated", "object half-space", "object 20", "object room", up[0], up[1], up[2], &commit,
        "material copper", "object slab 2mm film 10", "mode semi-infinite", "mode contact", "stream 20", "settings", "margins",  "start", "arm", "arm", "state",
        "hold 30", "start", "arm", "tune", "tune result", "arm", "calibrate room 25",  "abort", "arm", "abort", "clear",
    ];
    for line in lines { s.ask(0, line); }
    s.hand.world(3).set_latch();
    s.wait(5);
    for line in ["state", "cause", "clear"] { s.ask(3, line); }
    s.hand.world(3).connect_supply();
    s.wait(100);
    for line in ["state", "clear", "arm", "state", "abort", "arm", "state"] { s.ask(3, line); }
    s.wait(2500);
    for line in ["state", "start", "arm"] { s.ask(3, line); }
    s.hand.world(4).set_force_and_faults(0.0, std::iter::empty());
    s.wait(100);
    for line in ["state", "arm"] { s.ask(4, line); }
    let settings: Vec<String> = (1..=8).map(|n| s.ask(4, &format!("settings {n}"))).collect();
    s.wait(1200);
    for line in ["calibrate room 25", "calibrate display 33", "hold 25", "tune", "tune result", "calibrate display 30"] { s.ask(4, line); }
    for n in 0..8 { s.ask(4, settings[n].trim_start_matches("ok ")); }
    s.ask(4, "tune");
    for n in 0..8 { s.ask(4, settings[n].trim_start_matches("ok ")); }
    if std::env::var_os("TUNE").is_some() {
    s.ask(4, "tune");
    for _ in 0..60 { s.wait(1000); if s.ask(4, "tune result").starts_with("ok") { break; } }
    }
    println!("{}: worst {:.2} switch {:.2}", flash.name(), s.worst, s.hand.longest_switch_us());
}

#[test]
fn locks() {
    each(FlashTiming::Ideal);
    each(FlashTiming::Accelerated);
}
