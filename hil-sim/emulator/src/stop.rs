//! Why an emulated run ends early.
use std::fmt;

/// Direction and width of a register access.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// A load of that many bytes.
    Read(u8),
    /// A store of that many bytes.
    Write(u8),
}

impl fmt::Display for Access {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Access::Read(bytes) => write!(f, "{}-bit read", 8 * bytes),
            Access::Write(bytes) => write!(f, "{}-bit write", 8 * bytes),
        }
    }
}

/// Place in the image: function and address of the executing block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Demangled symbol, or `?` where the image names none.
    pub function: String,
    /// Address of the first instruction of the executing block (exact to the block, not the instruction).
    pub pc: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} (pc {:#010x})", self.function, self.pc)
    }
}

/// Why the machine cannot continue.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Stop {
    /// The image used a register, a bit or an access width that the emulated machine does not have.
    #[error(
        "{register} at {address:#010x} is not modelled: {access}, value {value:#x}, in {place}"
    )]
    NotModelled {
        /// Peripheral and register, with the bit where only the bit is missing.
        register: String,
        /// Address of the access; bit-band aliases are given as the register behind them.
        address: u32,
        /// Direction and width.
        access: Access,
        /// Value written, 0 for a read.
        value: u32,
        /// Where in the image.
        place: Place,
    },
    /// The image touched a peripheral whose clock it has not enabled (on silicon: reads 0, writes are lost).
    #[error(
        "{peripheral} used at {address:#010x} while its clock is off (set {enable} first): {access} in {place}"
    )]
    ClockOff {
        /// Peripheral.
        peripheral: String,
        /// Bit that would enable it.
        enable: String,
        /// Address of the access.
        address: u32,
        /// Direction and width.
        access: Access,
        /// Where in the image.
        place: Place,
    },
    /// Fewer flash wait states than the new core clock needs (RM0390 3.4.1, supply of 2.7 to 3.6 V).
    #[error(
        "FLASH_ACR.LATENCY = {latency} is too small for HCLK = {hclk_hz} Hz, which needs {needed} (in {place})"
    )]
    FlashLatency {
        /// Requested core clock.
        hclk_hz: u32,
        /// Wait states set.
        latency: u32,
        /// Wait states needed.
        needed: u32,
        /// Where in the image.
        place: Place,
    },
    /// A clock outside the range of the data sheet.
    #[error("{clock} = {hz} Hz is outside the allowed {min_hz} to {max_hz} Hz (in {place})")]
    ClockRange {
        /// Which clock.
        clock: &'static str,
        /// Its frequency.
        hz: u32,
        /// Lowest allowed.
        min_hz: u32,
        /// Highest allowed.
        max_hz: u32,
        /// Where in the image.
        place: Place,
    },
    /// The image used a device in a way that its manual forbids; silicon then does something that the manual does not say.
    #[error("{register} at {address:#010x}: {rule} (in {place})")]
    Misuse {
        /// Peripheral and register.
        register: String,
        /// Address of the register.
        address: u32,
        /// What was done, and what the manual demands.
        rule: &'static str,
        /// Where in the image.
        place: Place,
    },
    /// A fault in the fault handler while no watchdog runs: the core would stay in lockup.
    #[error("lockup: {cause} at priority {priority} in {place}")]
    Lockup {
        /// The last fault.
        cause: String,
        /// Execution priority at which it struck.
        priority: i32,
        /// Where in the image.
        place: Place,
    },
    /// The CPU emulation itself failed; a defect of this program, not of the image.
    #[error("the CPU emulation failed: {0}")]
    Emulator(String),
}

/// Why a register model does not accept an access.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// Register (or bit of it) without a model.
    NotModelled(&'static str),
    /// Offset without a model inside a known peripheral.
    Offset,
    /// See [`Stop::Misuse`].
    Misuse(&'static str),
    /// Access width that the register does not accept.
    Width,
    /// The peripheral's clock is off; names the enable bit's register and position.
    ClockOff(&'static str, u8),
    /// No device at this address: a bus error inside the emulated CPU.
    BusError,
    /// See [`Stop::FlashLatency`].
    FlashLatency { hclk_hz: u32, latency: u32, needed: u32 },
    /// See [`Stop::ClockRange`].
    ClockRange { clock: &'static str, hz: u32, min_hz: u32, max_hz: u32 },
}

/// Result of a register access.
pub(crate) type Answer<T> = Result<T, Refusal>;

/// Refuses `value` if it has bits outside `allowed`; `what` names the register and the bits that are not modelled.
pub(crate) fn only(value: u32, allowed: u32, what: &'static str) -> Answer<()> {
    if value & !allowed == 0 { Ok(()) } else { Err(Refusal::NotModelled(what)) }
}
