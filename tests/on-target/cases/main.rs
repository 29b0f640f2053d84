//! Tests on the microcontroller itself. Each begins with a reset; `after_reset` has those that provoke another one.
#![no_std]
#![no_main]

#[allow(
    dead_code,
    unused_imports,
    reason = "the firmware's own modules, of which the tests use some"
)]
#[path = "../../../src/board/mod.rs"]
mod board;

mod after_reset;
mod control;
mod converter;
mod cycles;
mod golden;
mod power_stage;
mod report;
mod running_board;
mod serial;
mod settings;
mod toy_display;
mod watchdogs;

/// Called at every start, before the runner says which test to run: a test that waits for this reset goes on.
#[embedded_test::setup]
fn continue_a_test_that_waits_for_this_reset() {
    after_reset::continue_if_expected();
    running_board::forget_the_last_test();
}
