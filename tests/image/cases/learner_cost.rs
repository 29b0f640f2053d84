//! What the heat-flux sensor costs: cycles of the control tick and of the task in which the finger is learnt.

use documented_figures::assert_compiled;
use image_proof::allowed::{LEARN, TICK};
use image_proof::compiler;
use image_tests::image;
use stm32_emulator::{Firmware, InterruptStats, OneFingerBoard};
use system_tests::{forces, scene};
use thermal_sim::World;
use thermal_sim::processor::FlashTiming;
use thermal_sim::run::run;

/// Statistics of all handlers over a contact of 10 s, or one that goes on after `duration_s`, on granite with a drawn finger.
fn handlers(
    firmware: &Firmware,
    device: &str,
    duration_s: f64,
    flash: FlashTiming,
) -> Vec<InterruptStats> {
    let finger = "[finger]\ntissue = \"layered\"\ndraw = 3\n";
    let touches = [(1.0, 2.0), (11.0, 0.0)];
    let until_end = touches.partition_point(|(t_s, _)| *t_s < duration_s);
    let touched = forces(&touches[..until_end]);
    let mut scene = scene("granite", duration_s, "", &[device, finger, &touched].concat());
    scene.chip.flash = flash;
    let world = World::new(&scene).expect("a plant for the scene");
    let mut board = OneFingerBoard::new(firmware, world).expect("the image starts");
    run(&scene, &mut board, |_| ()).expect("the image runs to the end");
    board.machine().stats().interrupts
}

const WITH_SENSOR: &str = "[device]\nflux_sensor = true\n";

fn of<'a>(handlers: &'a [InterruptStats], name: &str) -> Option<&'a InterruptStats> {
    handlers.iter().find(|handler| handler.name == name)
}

#[test]
fn a_heat_flux_sensor_costs_so_many_cycles_a_tick() {
    let firmware = Firmware::from_file(image()).expect("an image for this chip");
    let compiler = compiler::of_elf(&std::fs::read(image()).expect("the image"));
    let compiler = compiler.expect("a compiler");
    let [without, with] =
        ["", WITH_SENSOR].map(|device| handlers(&firmware, device, 12.0, FlashTiming::Ideal));
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
    // The finger is learnt for the first time half a second after its landing.
    for flash in [FlashTiming::Accelerated, FlashTiming::Unaccelerated] {
        let handlers = handlers(&firmware, WITH_SENSOR, 2.0, flash);
        let tick = of(&handlers, TICK).expect("ticks");
        let key = format!("learner.tick_max_{}", flash.name());
        assert_compiled(&key, tick.cycles_max as f64, &compiler);
    }
}
