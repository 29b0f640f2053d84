//! Faults that the release image reports after a reset, and starts that fail.

use image_tests::{Bare, START, image};
use object::{Object, ObjectSymbol};
use stm32_emulator::Firmware;
use system_tests::flash::erased;
use thermal_sim::processor::{CoreRegister, ResetCause};

fn firmware() -> Firmware {
    Firmware::from_file(image()).expect("an image for this chip")
}

/// Cycles after which a start has read the reset flags and has not yet set up its watchdogs.
const EARLY: u64 = 100_000;

/// The name of the stored fault: [`NO_RESET_FAULT`] if the reset caused none, as the device has no sensors.
fn cause(device: &mut Bare) -> String {
    let answer = device.answer("cause");
    let name = answer.strip_prefix("ok cause=").and_then(|rest| rest.split(' ').next());
    name.unwrap_or_else(|| panic!("{answer}")).to_owned()
}

const NO_RESET_FAULT: &str = "excitation";

/// A device whose program counter is corrupted while it reads the flash, before the watchdogs run.
fn with_a_failed_start() -> Bare {
    let mut device = Bare::switched_on(&firmware(), &erased());
    device.run(EARLY);
    device.0.flip_core_bit(CoreRegister::Pc, 20).expect("injected");
    device.run(2 * START);
    device
}

#[test]
fn an_unexpected_software_reset_is_a_fault_and_an_external_reset_is_none() {
    let firmware = firmware();
    for (reset, expected) in [
        (ResetCause::Software, "unasked-reset"),
        (ResetCause::Pin, NO_RESET_FAULT),
        (ResetCause::BrownOut, NO_RESET_FAULT),
        (ResetCause::PowerOn, NO_RESET_FAULT),
    ] {
        let mut device = Bare::switched_on(&firmware, &erased());
        // Before the first tick, so that nothing has tripped; twice, so that flags of the first are gone.
        for _ in 0..2 {
            device.run(EARLY);
            match reset {
                ResetCause::Software => device.0.request_reset(),
                ResetCause::Pin => device.0.pull_reset_pin(),
                ResetCause::BrownOut => device.0.brown_out(),
                _ => device.0.power_cycle(3),
            }
            .expect("starts anew");
        }
        device.run(START);
        assert_eq!(cause(&mut device), expected, "{reset:?}");
    }
}

#[test]
fn the_first_fault_survives_resets_and_not_a_power_cycle() {
    let mut device = with_a_failed_start();
    for step in 0..4 {
        let reset = match step {
            0 => device.0.pull_reset_pin(),
            1 => device.0.brown_out(),
            2 => device.0.request_reset(),
            _ => device.0.power_cycle(7),
        };
        reset.expect("starts anew");
        device.run(START);
        let expected = if step == 3 { NO_RESET_FAULT } else { "hard-fault" };
        assert_eq!(cause(&mut device), expected, "{step}");
    }
}

#[test]
fn a_start_that_fails_before_the_watchdogs_run_is_repeated() {
    let mut device = with_a_failed_start();
    let causes: Vec<_> = device.0.resets().iter().map(|reset| reset.cause).collect();
    assert_eq!(causes, [ResetCause::PowerOn, ResetCause::IndependentWatchdog]);
    assert_eq!(cause(&mut device), "hard-fault");
}

/// The resources of RTIC's tasks lie in `.uninit`, which no start-up code initialises. If a compiler takes the only value that the
/// program stores in one for its initial value, it leaves out the store, and reads find what the memory held at power-up.
#[test]
fn every_resource_of_the_tasks_is_written_at_the_start() {
    for fingers in [1, 5] {
        let path = stm32_emulator::build(fingers).expect("the image builds");
        let elf = std::fs::read(&path).expect("the file that was built");
        let elf = object::File::parse(&*elf).expect("an ELF file");
        let resources: Vec<_> = (elf.symbols())
            .filter(|symbol| symbol.name().is_ok_and(|name| name.contains("_resource_")))
            .filter(|symbol| symbol.size() > 0)
            .collect();
        assert!(resources.len() > 4, "{} resources", resources.len());
        let firmware = Firmware::from_file(&path).expect("an image for this chip");
        let mut device = Bare::switched_on(&firmware, &erased());
        let contents = |device: &Bare| -> Vec<_> {
            (resources.iter())
                .map(|symbol| {
                    let bytes = device.0.memory(symbol.address() as u32, symbol.size() as usize);
                    bytes.expect("in the RAM")
                })
                .collect()
        };
        let at_power_up = contents(&device);
        device.run(2 * START);
        for ((symbol, before), after) in resources.iter().zip(at_power_up).zip(contents(&device)) {
            assert_ne!(before, after, "{fingers}: {:?}", symbol.name());
        }
    }
}
