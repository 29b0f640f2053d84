//! What the firmware needs of a board, and the boards that have it.
//!
//! A board is a module with a `Board` that sets up its pins, clocks and peripherals and hands out what the
//! tasks own, and with the handlers that leave the bridge off when the program cannot go on. What does not
//! depend on the board lies beside it: the bridge driver, the queues between the tasks and the roll-call.

mod console;

#[cfg(feature = "nucleo-f446re")]
mod nucleo_f446re;

pub use console::Console;
#[cfg(feature = "nucleo-f446re")]
pub use nucleo_f446re::{
    Board, End, FINGERS, Memory, Outbox, PowerStage, Receiver, Record, Sampler, Transmitter,
    Trigger, Watchdog, WindowWatchdog, at_start, first_cause, keep_dose, kept_dose, pac, restart,
    stack_is_overrun,
};
