//! Faults, reset causes and core registers of the microcontroller, independent of an engine.

use std::fmt;
use std::str::FromStr;
use thermal_client::client::SIMULATED_UNIQUE_ID;

named_enum! {
    /// Cause of the last reset of the microcontroller (RCC_CSR).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum ResetCause {
        /// The supply came up.
        PowerOn = "power-on",
        /// SYSRESETREQ was written to AIRCR.
        Software = "software",
        /// The independent watchdog ran out.
        IndependentWatchdog = "independent-watchdog",
        /// The window watchdog ran out, or was refreshed outside its window.
        WindowWatchdog = "window-watchdog",
        /// The supply fell below the brown-out threshold, but the RAM kept its contents.
        BrownOut = "brown-out",
        /// The reset pin was pulled low.
        Pin = "reset-pin",
    }
}

impl fmt::Display for ResetCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

named_enum! {
    /// How long the core waits for the flash.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum FlashTiming {
        /// Not at all: the figures depend on the program's instructions alone, not on where they lie.
        #[default]
        Ideal = "ideal",
        /// Wait states, caches and prefetch as the program sets them in FLASH_ACR.
        Accelerated = "art",
        /// The wait states of FLASH_ACR with caches and prefetch off, whatever it says: the slowest case.
        Unaccelerated = "off",
    }
}

/// What is set or present before the program starts, and differs between chips and boards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChipState {
    /// BOR_LEV of the option bytes: 0 is level 3, as the board's preparation sets it; 3 is off, as delivered.
    pub brown_out_code: u8,
    /// Rate of the internal low-speed oscillator, which clocks the independent watchdog, Hz.
    pub lsi_hz: u32,
    /// Whether the 8 MHz clock of the debug probe is there at power-up.
    pub external_clock: bool,
    /// Time from switching the input of that clock on until its ready flag is set, us.
    pub external_clock_start_us: u32,
    /// Whether programming and erasing of the flash take the longest times of the data sheet, not the typical ones.
    pub slow_flash: bool,
    /// How long the core waits for the flash.
    pub flash: FlashTiming,
    /// Whether the emulator checks what it otherwise leaves out, to be fast: the alignment of accesses to several words, and
    /// that no peripheral is accessed right behind the enabling of its clock, or right before the return of a handler.
    pub strict: bool,
    /// The unique identifier that the factory gives each chip, in words.
    pub unique_id: [u32; 3],
}

impl ChipState {
    /// Range of the internal low-speed oscillator, Hz (DS10693).
    pub const LSI_HZ: std::ops::RangeInclusive<u32> = 17_000..=47_000;
    /// Range of the start-up time of the external clock, us: from that of a clock which runs to one that a program gives up.
    pub const EXTERNAL_CLOCK_START_US: std::ops::RangeInclusive<u32> = 1..=1_000_000;
}

impl Default for ChipState {
    /// The chip of a prepared board with its nominal oscillator and the typical times of its flash.
    fn default() -> Self {
        Self {
            brown_out_code: 0,
            lsi_hz: 32_000,
            external_clock: true,
            external_clock_start_us: 10,
            slow_flash: false,
            flash: FlashTiming::default(),
            strict: false,
            unique_id: [SIMULATED_UNIQUE_ID, 0x0046_0014, 0x0046_0018],
        }
    }
}

/// A register of the CPU or of its floating-point unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CoreRegister {
    /// R0 to R12.
    R(u8),
    /// The stack pointer in use.
    Sp,
    /// Link register.
    Lr,
    /// Address of the next instruction.
    Pc,
    /// Flags: N, Z, C, V, Q (31 to 27) and GE (19 to 16).
    Psr,
    /// S0 to S31.
    S(u8),
    /// Floating-point status and control.
    Fpscr,
}

impl fmt::Display for CoreRegister {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::R(n) => write!(f, "r{n}"),
            Self::Sp => f.write_str("sp"),
            Self::Lr => f.write_str("lr"),
            Self::Pc => f.write_str("pc"),
            Self::Psr => f.write_str("psr"),
            Self::S(n) => write!(f, "s{n}"),
            Self::Fpscr => f.write_str("fpscr"),
        }
    }
}

impl CoreRegister {
    /// Mask of the bits that can flip: the two lowest of SP and the lowest of PC are always 0, and flips of the execution
    /// state (T, IT) are not modelled.
    pub const fn bits(self) -> u32 {
        match self {
            Self::Sp => !3,
            Self::Pc => !1,
            Self::Psr => 0xf80f_0000,
            Self::Fpscr => 0xf7c0_009f,
            Self::R(13..) | Self::S(32..) => 0,
            _ => u32::MAX,
        }
    }
}

/// A fault of the microcontroller, or of the select lines by which it addresses the multiplexers of the board for five
/// fingers.
///
/// Its text, both ways: `ram-bit=0x20000010.3`, `core-bit=r4.7` (r0 to r12, sp, lr, pc, psr, s0 to s31, fpscr),
/// `register-bit=0x40010044.15`, `hung-core`, `debugger-halt`, `hse-stopped`, `hse-started`, `adc-stopped`, `adc2-stopped`,
/// `dma-stopped=2.0` (controller, stream), `brown-out`, `power-cycle=1` (seed of the noise in RAM), `reset-pin`, `software-reset`, `stack-overflow`,
/// `select-line-stuck=0.1` (line, level), `select-line-open=0` (line).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MachineFault {
    /// A bit (0 to 7) of a byte of the RAM flips.
    RamBit {
        /// Address of the byte.
        address: u32,
        /// Bit.
        bit: u8,
    },
    /// A bit of a core register flips.
    CoreBit {
        /// Register.
        register: CoreRegister,
        /// Bit.
        bit: u8,
    },
    /// A bit of a peripheral register flips.
    RegisterBit {
        /// Address of the word.
        address: u32,
        /// Bit.
        bit: u8,
    },
    /// The core executes no instruction until a reset.
    HungCore,
    /// A debugger halts the core; what it has selected in DBGMCU stands still too.
    DebuggerHalt,
    /// The external oscillator stops until it is started.
    HseStopped,
    /// The external oscillator comes, or comes back.
    HseStarted,
    /// The converter completes no conversion until a reset.
    AdcStopped,
    /// The converter of the heat-flux sensor completes no conversion until a reset.
    Adc2Stopped,
    /// A bus error ends a DMA stream.
    DmaStopped {
        /// 1 or 2.
        controller: u8,
        /// 0 to 7.
        stream: u8,
    },
    /// The supply dips; the RAM keeps its contents.
    BrownOut,
    /// The supply is off until the RAM has lost its contents.
    PowerCycle {
        /// Seed of the noise that the RAM contains afterwards.
        seed: u64,
    },
    /// The reset pin is pulled.
    ResetPin,
    /// The program requests a reset.
    SoftwareReset,
    /// The stack pointer is set to the end of the stack, so that the next push overflows.
    StackOverflow,
    /// A select line is shorted at its pin, to ground or to 3.3 V.
    SelectLineStuck {
        /// 0 to 2.
        line: u8,
        /// 0 or 1.
        level: u8,
    },
    /// The wire of a select line breaks: the multiplexers see the level of its pull-down.
    SelectLineOpen {
        /// 0 to 2.
        line: u8,
    },
}

/// A fault of the processor at a time of a scene, with microsecond resolution; at a whole millisecond it comes before the
/// step of the plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Injection {
    /// Time, s; negative while the scene settles.
    pub t_s: f64,
    /// The fault.
    pub fault: MachineFault,
}

/// Why a fault was not injected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotInjected {
    /// The engine has no processor whose part this is.
    #[error(
        "{fault} means nothing to engine {engine}, which has no processor; engine image has one"
    )]
    NotApplicable {
        /// Fault.
        fault: MachineFault,
        /// Name of the engine.
        engine: &'static str,
    },
    /// The machine refused it.
    #[error("{fault} was not injected: {reason}")]
    Refused {
        /// Fault.
        fault: MachineFault,
        /// Reason given by the machine.
        reason: String,
    },
}

impl fmt::Display for MachineFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RamBit { address, bit } => write!(f, "ram-bit={address:#010x}.{bit}"),
            Self::CoreBit { register, bit } => write!(f, "core-bit={register}.{bit}"),
            Self::RegisterBit { address, bit } => write!(f, "register-bit={address:#010x}.{bit}"),
            Self::HungCore => f.write_str("hung-core"),
            Self::DebuggerHalt => f.write_str("debugger-halt"),
            Self::HseStopped => f.write_str("hse-stopped"),
            Self::HseStarted => f.write_str("hse-started"),
            Self::AdcStopped => f.write_str("adc-stopped"),
            Self::Adc2Stopped => f.write_str("adc2-stopped"),
            Self::DmaStopped { controller, stream } => {
                write!(f, "dma-stopped={controller}.{stream}")
            }
            Self::BrownOut => f.write_str("brown-out"),
            Self::PowerCycle { seed } => write!(f, "power-cycle={seed}"),
            Self::ResetPin => f.write_str("reset-pin"),
            Self::SoftwareReset => f.write_str("software-reset"),
            Self::StackOverflow => f.write_str("stack-overflow"),
            Self::SelectLineStuck { line, level } => write!(f, "select-line-stuck={line}.{level}"),
            Self::SelectLineOpen { line } => write!(f, "select-line-open={line}"),
        }
    }
}

/// A text that is not a fault of the machine.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no fault of the machine; allowed are ram-bit=ADDRESS.BIT, core-bit=REGISTER.BIT, \
     register-bit=ADDRESS.BIT, hung-core, debugger-halt, hse-stopped, hse-started, adc-stopped, adc2-stopped, \
     dma-stopped=CONTROLLER.STREAM, brown-out, power-cycle=SEED, reset-pin, software-reset, stack-overflow, select-line-stuck=LINE.LEVEL, select-line-open=LINE with \
     lines 0 to 2 and levels 0 and 1"
)]
pub struct ParseMachineFaultError(String);

impl FromStr for MachineFault {
    type Err = ParseMachineFaultError;

    fn from_str(text: &str) -> Result<Self, ParseMachineFaultError> {
        parse(text).ok_or_else(|| ParseMachineFaultError(text.to_owned()))
    }
}

fn parse(text: &str) -> Option<MachineFault> {
    let (kind, value) = text.split_once('=').unwrap_or((text, ""));
    let pair = || value.split_once('.');
    let bit = || pair()?.1.parse().ok();
    let address = || number(pair()?.0);
    Some(match kind {
        "ram-bit" => MachineFault::RamBit { address: address()?, bit: bit()? },
        "register-bit" => MachineFault::RegisterBit { address: address()?, bit: bit()? },
        "core-bit" => MachineFault::CoreBit { register: register(pair()?.0)?, bit: bit()? },
        "dma-stopped" => {
            MachineFault::DmaStopped { controller: pair()?.0.parse().ok()?, stream: bit()? }
        }
        "power-cycle" => MachineFault::PowerCycle { seed: value.parse().ok()? },
        "select-line-stuck" => MachineFault::SelectLineStuck {
            line: up_to(2, pair()?.0)?,
            level: up_to(1, pair()?.1)?,
        },
        "select-line-open" => MachineFault::SelectLineOpen { line: up_to(2, value)? },
        _ if !value.is_empty() => return None,
        "hung-core" => MachineFault::HungCore,
        "debugger-halt" => MachineFault::DebuggerHalt,
        "hse-stopped" => MachineFault::HseStopped,
        "hse-started" => MachineFault::HseStarted,
        "adc-stopped" => MachineFault::AdcStopped,
        "adc2-stopped" => MachineFault::Adc2Stopped,
        "brown-out" => MachineFault::BrownOut,
        "reset-pin" => MachineFault::ResetPin,
        "software-reset" => MachineFault::SoftwareReset,
        "stack-overflow" => MachineFault::StackOverflow,
        _ => return None,
    })
}

fn up_to(most: u8, text: &str) -> Option<u8> {
    text.parse().ok().filter(|number| *number <= most)
}

fn number(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(hex) => u32::from_str_radix(hex, 16).ok(),
        None => text.parse().ok(),
    }
}

fn register(text: &str) -> Option<CoreRegister> {
    let index = |prefix| text.strip_prefix(prefix)?.parse().ok();
    Some(match text {
        "sp" => CoreRegister::Sp,
        "lr" => CoreRegister::Lr,
        "pc" => CoreRegister::Pc,
        "psr" => CoreRegister::Psr,
        "fpscr" => CoreRegister::Fpscr,
        _ => match (index('r'), index('s')) {
            (Some(n), _) => CoreRegister::R(n),
            (_, Some(n)) => CoreRegister::S(n),
            _ => return None,
        },
    })
}
