//! Settings survive a restart, and a reset that interrupts their storing. The tests leave factory defaults in the flash.

use core::sync::atomic::Ordering::Relaxed;

use embedded_storage::nor_flash::{NorFlash, ReadNorFlash};
use stm32f4xx_hal::pac::{FLASH, IWDG};
use thermal_display::settings::{
    Settings, SettingsRecord, SettingsStore, StoredSettings, Tile, encode_settings_record,
};

use crate::after_reset::{KEPT, Step, continue_with};
use crate::board::nucleo_f446re::reset_cause::ResetCause;
use crate::board::nucleo_f446re::settings_flash::SettingsFlash;
use crate::board::nucleo_f446re::settings_storage::save_pending_and_load;
use crate::board::{FINGERS, restart_to_save};
use crate::report;
use crate::running_board::forget_the_last_test;

/// Moments after the start of a save at which a watchdog resets the chip, at the nominal rate of its oscillator, ms. The first
/// save to an erased flash also erases, which takes a quarter of a second.
const MOMENTS_MS: [u16; 16] = [1, 2, 3, 4, 5, 6, 8, 12, 1, 3, 5, 10, 100, 200, 300, 500];
/// From this moment on, the flash is erased before.
const FIRST_ON_ERASED: usize = 8;

/// Settings that differ from save to save.
fn settings(number: usize) -> [StoredSettings; FINGERS] {
    let mut settings = Settings::default();
    let gain_k_s_a = Tile::FACTORY_DEFAULT.gain_k_s_a * (1.0 + 0.001 * number as f64);
    settings.set_tile(Tile { gain_k_s_a, ..Tile::FACTORY_DEFAULT });
    [StoredSettings::from_settings(&settings); FINGERS]
}

fn record(number: usize) -> SettingsRecord {
    encode_settings_record(Some(&settings(number).into()))
}

fn flash() -> FLASH {
    // SAFETY: the firmware's storage, which owns it, does not run beside.
    unsafe { FLASH::steal() }
}

/// The record that the flash holds, of which nothing may be damaged.
fn stored() -> SettingsRecord {
    let flash = flash();
    let mut store = SettingsStore::<_, FINGERS>::new(SettingsFlash::new(&flash));
    let loaded = store.load().unwrap_or_else(|error| panic!("{error}"));
    encode_settings_record(loaded.as_ref())
}

fn restore_factory_defaults() {
    let flash = flash();
    let mut store = SettingsStore::<_, FINGERS>::new(SettingsFlash::new(&flash));
    store.save(None).unwrap_or_else(|error| panic!("{error}"));
}

fn erase() {
    let flash = flash();
    let mut flash = SettingsFlash::new(&flash);
    let erased = flash.erase(0, flash.capacity() as u32);
    erased.unwrap_or_else(|error| panic!("{error}"));
}

/// Restarts to store settings; the next start goes on with `step`.
fn restart(number: usize, step: Step) -> ! {
    if number >= FIRST_ON_ERASED {
        erase();
    }
    KEPT.number.store(number as u32, Relaxed);
    continue_with(step);
    restart_to_save(&record(number))
}

/// After the restart: the firmware stores what waits, and finds it.
pub fn find_saved() {
    let number = KEPT.number.load(Relaxed) as usize;
    let result = save_pending_and_load(&flash());
    assert!(matches!(result.save_result, Some(Ok(()))), "it stores what waits");
    assert!(stored() == record(number), "and finds it");
    restore_factory_defaults();
}

/// Starts the watchdog, which resets the chip while the firmware stores what waits.
pub fn interrupt_save() {
    forget_the_last_test();
    let number = KEPT.number.load(Relaxed) as usize;
    // SAFETY: nothing else uses it; only the reset that is expected stops it.
    let watchdog = unsafe { IWDG::steal() };
    watchdog.kr().write(|w| w.key().start());
    watchdog.kr().write(|w| w.key().unlock());
    watchdog.pr().write(|w| w.pr().divide_by32());
    watchdog.rlr().write(|w| w.rl().set(MOMENTS_MS[number]));
    while watchdog.sr().read().bits() != 0 {}
    watchdog.kr().write(|w| w.key().feed());
    continue_with(Step::RecoverSettings);
    let _ = save_pending_and_load(&flash());
    loop {
        cortex_m::asm::nop();
    }
}

/// After the interruption: the flash holds the old settings or the new ones, and the second attempt stores the new ones.
pub fn recover(cause: ResetCause) {
    let number = KEPT.number.load(Relaxed) as usize;
    assert_eq!(cause.name(), ResetCause::Watchdog.name());
    let before = match number {
        1..FIRST_ON_ERASED => record(number - 1),
        _ => encode_settings_record::<FINGERS>(None),
    };
    let found = stored();
    let was_stored = found == record(number);
    assert!(was_stored || found == before, "the old or the new settings");
    let result = save_pending_and_load(&flash());
    let is_stored = match result.save_result {
        Some(result) => result.is_ok(),
        // The first attempt had ended.
        None => was_stored,
    };
    assert!(is_stored && stored() == record(number), "the second attempt stores them");
    report::line(format_args!(
        "reset {} ms after the start of the save: the {} settings were there",
        MOMENTS_MS[number],
        if was_stored { "new" } else { "old" }
    ));
    if number + 1 < MOMENTS_MS.len() {
        restart(number + 1, Step::InterruptSave);
    }
    restore_factory_defaults();
}

#[embedded_test::tests]
mod tests {
    use super::{restart, restore_factory_defaults};
    use crate::after_reset::Step;

    #[test]
    fn saved_settings_are_found_after_the_restart() {
        restart(1, Step::FindSavedSettings)
    }

    #[test]
    fn a_save_that_a_reset_interrupts_loses_nothing() {
        restore_factory_defaults();
        restart(0, Step::InterruptSave)
    }
}
