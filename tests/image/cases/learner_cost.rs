//! What the heat-flux sensor costs: cycles of the control tick and of the task in which the finger is learnt.

use documented_figures::assert_compiled;
use image_proof::allowed::{LEARN, TICK};
use image_proof::compiler;
use image_tests::image;
use stm32_emulator::{Firmware, InterruptStats, OneFingerBoard};
use system_tests::{forces, scene};
use thermal_sim::World;
use thermal_sim::run::run;

/// Statistics of all handlers over a contact of 10 s on granite with a drawn finger.
fn handlers(firmware: &Firmware, device: &str) -> Vec<InterruptStats> {
    let finger = "[finger]\ntissue = \"layered\"\ndraw = 3\n";
    let touched = forces(&[(1.0, 2.0), (11.0, 0.0)]);
    let scene = scene("granite", 12.0, "", &[device, finger, &touched].concat());
    let world = World::new(&scene).expect("a plant for the scene");
    let mut board = OneFingerBoard::new(firmware, world).expect("the image starts");
    run(&scene, &mut board, |_| ()).expect("the image runs to the end");
    board.machine().stats().interrupts
}

fn of<'a>(handlers: &'a [InterruptStats], name: &str) -> Option<&'a InterruptStats> {
    handlers.iter().find(|handler| handler.name == name)
}

#[test]
fn a_heat_flux_sensor_costs_so_many_cycles_a_tick() {
    let firmware = Firmware::from_file(image()).expect("an image for this chip");
    let compiler = compiler::of_elf(&std::fs::read(image()).expect("the image"));
    let compiler = compiler.expect("a compiler");
    let [without, with] =
        ["", "[device]\nflux_sensor = true\n"].map(|device| handlers(&firmware, device));
    assert!(of(&without, LEARN).is_none(), "nothing is learnt");
    let ticks = [&without, &with].map(|handlers| of(handlers, TICK).expect("ticks"));
    let learner = of(&with, LEARN).expect("a learner");
    // Once after every tenth tick, from the first one with the sensor on.
    assert!((ticks[1].count / 10).abs_diff(learner.count) < 3);
    let [without, with] = ticks;
    let per_tick = learner.cycles_mean * learner.count as f64 / with.count as f64;
    for (key, measured) in [
        ("learner.tick_mean", with.cycles_mean - without.cycles_mean),
        ("learner.task_mean", per_tick),
        ("learner.tick_max", with.cycles_max as f64),
        ("learner.task_max", learner.cycles_max as f64),
    ] {
        assert_compiled(key, measured, &compiler);
    }
}
