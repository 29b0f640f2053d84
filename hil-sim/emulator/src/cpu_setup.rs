//! Memories and hooks of the CPU emulation.
use super::Wiring;
use super::elf::{FLASH_BASE, FLASH_SIZE, RAM_BASE, RAM_SIZE};
use super::flash::{Flash, SETTINGS};
use super::state::{self, Cpu, Exit, State};
use unicorn_engine::{
    Arch, ArmCpuModel, HookType, MemType, Mode, Prot, RegisterARM, TlbEntry, TlbType, Unicorn,
    uc_error,
};

/// Ranges whose accesses go to the register models, reserved gaps included: signature and option bytes, bit-band
/// aliases, APB and AHB1, AHB2, external memory controllers, the core's own peripherals.
const DEVICES: [(u64, u64); 7] = [
    (0x1fff_0000, 0x1_0000),
    (0x2200_0000, 0x40_0000),
    (0x4000_0000, 0x8_0000),
    (0x4200_0000, 0x100_0000),
    (0x5000_0000, 0x6_1000),
    (0xa000_0000, 0x2000),
    (0xe000_0000, 0x10_0000),
];

/// EPSR outside of an IT block.
const THUMB_UNCONDITIONAL: u64 = 1 << 24;

/// Maps the memories and installs the hooks.
pub(super) fn create_cpu<W: Wiring + 'static>(
    state: State<W>,
    flash: &[u8],
) -> Result<Cpu<'static, W>, uc_error> {
    let mut cpu = Unicorn::new_with_data(Arch::ARM, Mode::THUMB | Mode::MCLASS, state)?;
    cpu.ctl_set_cpu_model(ArmCpuModel::CORTEX_M4 as i32)?;
    let settings_are_writable = Flash::has_settings(flash);
    let (from, to) = ((SETTINGS.start - FLASH_BASE) as usize, (SETTINGS.end - FLASH_BASE) as usize);
    // BOOT0 is low: the flash also appears at 0 (RM0390 2.4)
    for base in [0, FLASH_BASE] {
        // Each part is a whole number of pages, and not empty.
        let parts = if settings_are_writable {
            [0..from, to..flash.len()]
        } else {
            [0..to, to..flash.len()]
        };
        for part in parts {
            let (base, part) = (u64::from(base) + part.start as u64, &flash[part.clone()]);
            cpu.mem_map(base, part.len() as u64, Prot::READ | Prot::EXEC)?;
            cpu.mem_write(base, part)?;
        }
        if settings_are_writable {
            cpu.mmio_map(
                u64::from(base) + from as u64,
                (to - from) as u64,
                Some(|cpu: &mut Unicorn<'_, State<W>>, offset: u64, bytes: usize| {
                    u64::from(state::on_flash_read(
                        cpu,
                        SETTINGS.start + offset as u32,
                        bytes as u8,
                    ))
                }),
                Some(|cpu: &mut Unicorn<'_, State<W>>, offset: u64, bytes: usize, value: u64| {
                    state::on_flash_write(
                        cpu,
                        SETTINGS.start + offset as u32,
                        bytes as u8,
                        value as u32,
                    );
                }),
            )?;
        }
    }
    cpu.mem_map(u64::from(RAM_BASE), u64::from(RAM_SIZE), Prot::ALL)?;
    for (base, size) in DEVICES {
        cpu.mmio_map(
            base,
            size,
            Some(move |cpu: &mut Unicorn<'_, State<W>>, offset: u64, bytes: usize| {
                u64::from(state::on_read(cpu, (base + offset) as u32, bytes as u8))
            }),
            Some(move |cpu: &mut Unicorn<'_, State<W>>, offset: u64, bytes: usize, value: u64| {
                state::on_write(cpu, (base + offset) as u32, bytes as u8, value as u32);
            }),
        )?;
    }
    cpu.add_block_hook(1, 0, |cpu, address, bytes| state::on_block(cpu, address as u32, bytes))?;
    cpu.add_intr_hook(|cpu, number| {
        cpu.get_data_mut().exit = Exit::Exception(number);
        if let Err(error) = cpu.emu_stop() {
            debug_assert!(false, "{error:?}");
        }
    })?;
    // A page that may be executed, or that a hook watches, takes the slow path at every store. So data accesses
    // get pages without execution (a fetch maps the page anew, with it), and the hooks leave the RAM out.
    cpu.ctl_set_tlb_type(TlbType::VIRTUAL)?;
    cpu.add_tlb_hook(0, u64::from(u32::MAX), |cpu, page, kind| {
        let perms = if kind == MemType::FETCH {
            Prot::ALL
        } else {
            // A missing page leaves the instruction's condition in the CPU's state, and the next block would run under that
            // condition.
            if let Err(error) = cpu.reg_write(RegisterARM::EPSR, THUMB_UNCONDITIONAL) {
                debug_assert!(false, "{error:?}");
            }
            Prot::READ | Prot::WRITE
        };
        Some(TlbEntry { paddr: page, perms })
    })?;
    for (first, last) in [(0, RAM_BASE - 1), (RAM_BASE + RAM_SIZE, u32::MAX)] {
        cpu.add_mem_hook(
            HookType::MEM_UNMAPPED | HookType::MEM_PROT,
            u64::from(first),
            u64::from(last),
            |cpu, kind, address, _, value| {
                let flash = FLASH_BASE..FLASH_BASE + FLASH_SIZE;
                let to_flash = kind == MemType::WRITE_PROT && flash.contains(&(address as u32));
                cpu.get_data_mut().invalid = Some((address as u32, value as u32, to_flash));
                false
            },
        )?;
    }
    Ok(cpu)
}
