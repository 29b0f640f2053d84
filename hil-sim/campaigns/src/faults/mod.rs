//! The fault-injection matrix: every single fault, in many scenes, at many moments.
//!
//! ```text
//! list of entries (fault, signs, reasons)  x  places (scene, moments)
//!        -> scene with the fault in it -> device (image or native) -> trace and answers
//!        -> when a sign is reached in the plant's truth, when the current ends, what the device says  -> verdict
//! ```
//!
//! What counts is laid down in [the list](entries) before anything runs: which deviation of the plant makes a fault
//! detectable, and which words of the device are then right. What every run is held to is in [`Verdict`]: the skin
//! within 13 to 45 °C, less than a minute of CEM43, no current from 50 ms after the first sign on, a right reason, and no
//! trip before the fault.

mod campaign;
mod entry;
mod flips;
mod list;
mod normal;
mod page;
mod pairs;
mod place;
mod random;
mod script;
mod sign;
mod table;
mod trial;
mod verdict;

pub use campaign::{Outline, Plan};
pub use entry::{Entry, Injected, Right};
pub use flips::{Class, Flip, Flipped, Memory, Reference, Region, flip_table};
pub use list::entries;
pub use normal::{Session, Used, use_table};
pub use page::{HTML, page};
pub use pairs::{Pair, RanPair, pair_table, pairs};
pub use place::{Moment, Place};
pub use random::{Campaign, Ran, summary};
pub use sign::Sign;
pub use table::table;
pub use trial::Trial;
pub use verdict::{Breach, Verdict};
