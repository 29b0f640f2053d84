//! Bring-up: leads a person from a bare board to sign-off.
//!
//! ```text
//! stages (data) -> Procedure -+-> Bench: hands and instruments of a person, or of the surroundings of an emulated board
//!                             +-> Client: self-test, raw, board, state, telemetry of the device
//!                             -> Report: every value, expected and found, findings -> page, JSON
//! ```
//!
//! The stages follow the order of power. A check that fails names what is broken; the procedure goes on where that is safe,
//! and does not start a stage that the failure makes unsafe. No bridge is driven by any other way than the device's own
//! self-test and its armed state, both of which need a comparator that has passed its tests.

mod bench;
mod check;
mod emulated;
mod fault_words;
mod page;
mod procedure;
mod report;
mod routines;
mod simulated;
mod stages;
mod terminal;
mod unit;

pub use bench::{Bench, BenchError, Measurement};
pub use check::{Check, Expected, ManualStep, Reading, Routine, Stage, StageId, Step, Value};
pub use emulated::EmulatedBench;
pub use page::page;
pub use procedure::{Interruption, OtherDevice, bring_up};
pub use report::{OtherImage, Record, Report, Resume, Verdict};
pub use simulated::SimulatedBoard;
pub use stages::STAGES;
pub use terminal::Terminal;
pub use unit::{TypedValueError, Unit};
