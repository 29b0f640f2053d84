//! Injection of faults into the running machine, each at its present cycle.
//!
//! A flip changes one stored bit, as radiation does. Flips that cannot be modelled faithfully are refused.
use super::chip::{ADC1, ADC2};
use super::elf::{RAM_BASE, RAM_SIZE};
use super::halt::Halt;
use super::mcu::{Machine, emulator};
use super::state::{Refused, get};
use super::stop::{Access, Answer, Refusal, Stop};
use super::{Wiring, exceptions};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};
use std::fmt;
use thermal_sim::processor::{CoreRegister, ResetCause};
use unicorn_engine::RegisterARM as Reg;

/// Why a fault was not injected; the machine is as before.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InjectError {
    /// The address is not in the RAM.
    #[error("{0:#010x} is not in the RAM, which is {RAM_BASE:#010x} to {last:#010x}", last = RAM_BASE + RAM_SIZE - 1)]
    NotRam(u32),
    /// The place has no such bit.
    #[error("{place} has no bit {bit} to flip; its bits are {bits:#010x}")]
    NoBit {
        /// Register or address.
        place: String,
        /// Requested bit.
        bit: u8,
        /// Mask of those that can flip.
        bits: u32,
    },
    /// The register model does not take the flipped value, or has no such register.
    #[error("the register does not take its flipped value: {0}")]
    Refused(Stop),
    /// No such DMA stream.
    #[error(
        "DMA{controller} stream {stream} does not exist: controllers are 1 and 2, streams 0 to 7"
    )]
    NoStream {
        /// Controller.
        controller: u8,
        /// Stream.
        stream: u8,
    },
    /// The DMA stream is not enabled, so it cannot be stopped.
    #[error("DMA{controller} stream {stream} is not enabled now")]
    StreamOff {
        /// Controller.
        controller: u8,
        /// Stream.
        stream: u8,
    },
    /// The image has no symbol for the end of its stack.
    #[error("the image has no symbol for the end of its stack")]
    NoStackEnd,
    /// The CPU emulation failed.
    #[error(transparent)]
    Stopped(#[from] Stop),
}

/// A mask of one bit of `bits`.
fn one_bit(place: impl fmt::Display, bit: u8, bits: u32) -> Result<u32, InjectError> {
    1u32.checked_shl(bit.into()).filter(|mask| bits & mask != 0).ok_or_else(|| InjectError::NoBit {
        place: place.to_string(),
        bit,
        bits,
    })
}

/// The flipped value, unless it stops the clock of a device other than the window watchdog.
fn stops_no_clock(address: u32, old: u32, mask: u32) -> Answer<u32> {
    let enables = matches!(address, 0x4002_3830 | 0x4002_3840 | 0x4002_3844);
    let modelled = (address, mask) == (0x4002_3840, 1 << 11);
    if enables && !modelled && old & mask != 0 {
        return Err(Refusal::NotModelled("a clock that stops under a device"));
    }
    Ok(old ^ mask)
}

impl<W: Wiring + 'static> Machine<W> {
    /// Flips one bit (0 to 7) of the byte at an address of the RAM.
    ///
    /// # Errors
    /// The address is not in the RAM, or the byte has no such bit.
    pub fn flip_ram_bit(&mut self, address: u32, bit: u8) -> Result<(), InjectError> {
        let index = address
            .checked_sub(RAM_BASE)
            .filter(|offset| *offset < RAM_SIZE)
            .ok_or(InjectError::NotRam(address))? as usize;
        let mask = one_bit(format_args!("the byte at {address:#010x}"), bit, 0xff)? as u8;
        let mut byte = [0];
        self.cpu.mem_read(address.into(), &mut byte).map_err(emulator)?;
        if byte[0] == self.initial_ram[index] {
            self.initial_ram[index] ^= mask; // otherwise the flip would count as use of the stack
        }
        self.cpu.mem_write(address.into(), &[byte[0] ^ mask]).map_err(emulator)?;
        Ok(())
    }

    /// Flips one bit of a core register between two basic blocks, or in sleep.
    ///
    /// # Errors
    /// The register does not exist, or has no such bit that can flip.
    pub fn flip_core_bit(&mut self, register: CoreRegister, bit: u8) -> Result<(), InjectError> {
        let mask = one_bit(register, bit, register.bits())?;
        let cpu = &mut self.cpu;
        // The emulation numbers R0 to R12, and D0 to D15, consecutively.
        let emulated = match register {
            CoreRegister::R(n) => Reg::R0 as i32 + i32::from(n),
            CoreRegister::Sp => Reg::SP as i32,
            CoreRegister::Lr => Reg::LR as i32,
            CoreRegister::Fpscr => Reg::FPSCR as i32,
            CoreRegister::Pc => {
                let pc = get(cpu, Reg::PC) ^ mask;
                cpu.reg_write(Reg::PC, u64::from(pc | 1)).map_err(emulator)?;
                return Ok(());
            }
            CoreRegister::Psr => {
                let xpsr = get(cpu, Reg::XPSR) ^ mask;
                exceptions::set_xpsr(cpu, xpsr).map_err(|e| Stop::Emulator(format!("{e:?}")))?;
                return Ok(());
            }
            CoreRegister::S(n) => {
                let pair = Reg::D0 as i32 + i32::from(n / 2);
                let old = cpu.reg_read(pair).map_err(emulator)?;
                let new = old ^ u64::from(mask) << (32 * (n % 2));
                return cpu.reg_write(pair, new).map_err(|e| emulator(e).into());
            }
        };
        let old = cpu.reg_read(emulated).map_err(emulator)?;
        cpu.reg_write(emulated, old ^ u64::from(mask)).map_err(emulator)?;
        Ok(())
    }

    /// Sets the stack pointer in use to the end of the stack, as after unbounded recursion: the next push overflows it, and
    /// the running code pops other data.
    ///
    /// # Errors
    /// The image has no symbol for the end of its stack.
    pub fn exhaust_stack(&mut self) -> Result<(), InjectError> {
        let end = self.stack_end().ok_or(InjectError::NoStackEnd)?;
        let cpu = &mut self.cpu;
        cpu.reg_write(Reg::SP, u64::from(end.next_multiple_of(8))).map_err(emulator)?;
        Ok(())
    }

    /// Flips one bit of the device register at a word address by a bus read and a write, with the effects that both have on
    /// the device (a flag that is cleared by writing 0 can be cleared but not set). An interrupt's enable or pending bit is
    /// flipped through either of its two registers. BDTR of TIM1 and TIM8 is flipped although it is locked.
    ///
    /// # Errors
    /// [`InjectError::Refused`]: the register or the value is not modelled, or its clock is off; or the flip would stop the
    /// clock of a device other than the window watchdog.
    pub fn flip_register_bit(&mut self, address: u32, bit: u8) -> Result<(), InjectError> {
        let mask = one_bit(format_args!("the register at {address:#010x}"), bit, u32::MAX)?;
        let now = self.now();
        let chip = self.chip_mut();
        // Their LOCK protects from writes, not from radiation.
        if mask & 0xffff != 0 && chip.flip_bdtr(address, mask, now) {
            return Ok(());
        }
        let (load_at, store_at, value) = match address {
            // set- and clear-enable, set- and clear-pending registers of the interrupts (ARMv7-M B3.4)
            0xe000_e100..0xe000_e300 => {
                let set = address & !0x80;
                let is_set = chip.read(set, now, 0).map(|bits| bits & mask != 0);
                (set, if is_set == Ok(true) { set | 0x80 } else { set }, Ok(mask))
            }
            _ => {
                let old = chip.read(address, now, 0);
                (address, address, old.and_then(|old| stops_no_clock(address, old, mask)))
            }
        };
        let value = self.or_refused(value, load_at, Access::Read(4), 0)?;
        let chip = self.chip_mut();
        let stored = chip.write(store_at, 4, value, now);
        self.or_refused(stored, store_at, Access::Write(4), value)?;
        Ok(())
    }

    fn or_refused<T>(
        &self,
        answer: Answer<T>,
        address: u32,
        access: Access,
        value: u32,
    ) -> Result<T, InjectError> {
        answer.map_err(|refusal: Refusal| {
            InjectError::Refused(self.refusal(Refused {
                refusal,
                address,
                access,
                value,
                pc: get(&self.cpu, Reg::PC),
            }))
        })
    }

    /// Halts the CPU until a reset; all other devices continue.
    pub fn hang_core(&mut self) {
        self.halt = Some(Halt::Hung);
    }

    /// A debugger halts the core. What DBGMCU selects stands still with it; all other devices continue. A reset ends the halt.
    pub fn halt_by_debugger(&mut self) {
        let now = self.now();
        self.chip_mut().set_halted_by_debugger(true, now);
        self.hang_core();
    }

    /// The debugger lets the halted core continue.
    pub fn continue_by_debugger(&mut self) {
        let now = self.now();
        self.chip_mut().set_halted_by_debugger(false, now);
        self.halt = None;
    }

    /// The external oscillator comes, or comes back after [`stop_hse`](Self::stop_hse).
    pub fn start_hse(&mut self) {
        let now = self.now();
        self.chip_mut().start_hse(now);
    }

    /// Stops the external oscillator, through resets and power cycles, until [`start_hse`](Self::start_hse). With clock security on (RCC_CR.CSSON) the
    /// system continues on the internal oscillator, the NMI is raised, and enabled breaks of TIM1 and TIM8 act. Without it, a
    /// system clock derived from the oscillator stops: CPU and timers halt, pins keep their present level, and only the
    /// independent watchdog counts.
    ///
    /// # Errors
    /// [`InjectError::Refused`]: the bus prescalers suit no clock of the internal oscillator.
    pub fn stop_hse(&mut self) -> Result<(), InjectError> {
        let now = self.now();
        let answer = self.chip_mut().stop_hse(now);
        let clocked = self.or_refused(answer, 0x4002_3800, Access::Write(4), 0)?;
        if !clocked {
            self.hang_core();
        }
        Ok(())
    }

    /// No conversion of ADC1 ends until it is reset.
    pub fn stop_adc(&mut self) {
        let now = self.now();
        self.chip_mut().stop_adc(ADC1, now);
    }

    /// No conversion of ADC2 ends until it is reset.
    pub fn stop_adc2(&mut self) {
        let now = self.now();
        self.chip_mut().stop_adc(ADC2, now);
    }

    /// Ends a DMA stream (controller 1 or 2, stream 0 to 7) by a bus error: disabled, transfer-error flag set.
    ///
    /// # Errors
    /// There is no such stream, or it is not enabled.
    pub fn stop_dma(&mut self, controller: u8, stream: u8) -> Result<(), InjectError> {
        if !matches!((controller, stream), (1..=2, 0..=7)) {
            return Err(InjectError::NoStream { controller, stream });
        }
        let now = self.now();
        let chip = self.chip_mut();
        if chip.stop_stream(usize::from(controller - 1), stream.into(), now) {
            Ok(())
        } else {
            Err(InjectError::StreamOff { controller, stream })
        }
    }

    /// Resets as a supply below the brown-out threshold does (BORRSTF); the RAM keeps its contents.
    ///
    /// # Errors
    /// The image cannot be started.
    pub fn brown_out(&mut self) -> Result<(), Stop> {
        self.system_reset(ResetCause::BrownOut)
    }

    /// Pulls the reset pin low and releases it (PINRSTF).
    ///
    /// # Errors
    /// The image cannot be started.
    pub fn pull_reset_pin(&mut self) -> Result<(), Stop> {
        self.system_reset(ResetCause::Pin)
    }

    /// Resets as a software request does (SFTRSTF).
    ///
    /// # Errors
    /// The image cannot be started.
    pub fn request_reset(&mut self) -> Result<(), Stop> {
        self.system_reset(ResetCause::Software)
    }

    /// Stores a word to the flash of the settings, as runaway code may do.
    ///
    /// # Errors
    /// [`InjectError::Refused`]: not modelled in the present state of the flash.
    pub fn stray_store(&mut self, address: u32, value: u32) -> Result<(), InjectError> {
        let now = self.now();
        let answer = self.chip_mut().store_flash(address, 4, value, now);
        self.or_refused(answer, address, Access::Write(4), value)
    }

    /// Switches the supply off and on: the RAM holds noise of `seed`, the flash is kept, and no time passes without supply.
    ///
    /// # Errors
    /// The image cannot be started.
    pub fn power_cycle(&mut self, seed: u64) -> Result<(), Stop> {
        Xoshiro256PlusPlus::seed_from_u64(seed).fill_bytes(&mut self.initial_ram);
        self.system_reset(ResetCause::PowerOn)
    }
}
