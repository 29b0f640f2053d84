//! What the firmware needs from a board, and the boards that provide it.
//!
//! A board is a module with a `Board` that sets up pins, clocks and peripherals and hands out what
//! the tasks own. It also has the exception handlers that turn the bridges off when the program
//! cannot continue. The control loop and the console do not depend on the board, nor do the parts
//! in the library: bridge driver, queue of lines, task liveness.

mod console;
mod control_loop;

#[cfg(feature = "nucleo-f446re")]
pub(crate) mod nucleo_f446re;

pub use console::Console;
pub use control_loop::ControlLoop;
#[cfg(feature = "nucleo-f446re")]
pub use nucleo_f446re::{
    BlankOrToBeAnsweredLine, Board, ChipMonitor, ComparatorSide, EmergencyStop, FINGERS,
    FingerPowerStage, FluxConverter, IndependentWatchdog, Outbox, Receiver, SampleError,
    SampleTrigger, Sampler, StaticMemory, Transmitter, TriggerInput, TriggerOutput,
    TripCauseRecorder, WindowWatchdog, board_status_now, line_losses, pac, restart_to_save,
    save_dose_if_changed, stack_is_overrun,
};
