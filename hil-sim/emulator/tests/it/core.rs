//! The emulated core against the ARMv7-M Architecture Reference Manual.
use stm32_emulator::{Halted, Stop};
use thermal_sim::processor::{CoreRegister, ResetCause};

use crate::probe;

const DONE: u32 = 0xd0e;
/// Log of the middle interrupt: the high one preempts its handler, the low one follows it (B1.5.4).
const MIDDLE: [u32; 5] = [0x116, 0x217, 0x101, 0x102, 0x318];

#[test]
fn exceptions_nest_tail_chain_and_obey_the_mask_registers() {
    let (machine, log) = probe::run(0, 1_000_000);
    let supervisor = [0x2000 | 11, 0x2100, 0x1000 | 14]; // PendSV waits for the more urgent SVCall
    let mut wanted = vec![1];
    wanted.extend(MIDDLE);
    wanted.extend([2, 3]); // pended under PRIMASK: nothing until it is cleared
    wanted.extend(MIDDLE);
    wanted.extend([4, 0x217, 5]); // BASEPRI = 0x80 lets only the more urgent one through
    wanted.extend(MIDDLE);
    wanted.push(6);
    wanted.extend(supervisor);
    wanted.push(7);
    wanted.extend(supervisor);
    wanted.push(0x11 | 2 << 8); // kept register; SPSEL = 1 after the return to the process stack
    wanted.extend([8, 0x318, 9]); // WFI wakes although PRIMASK is set; the handler runs after it is cleared
    wanted.extend([8, 0, 6, DONE]); // (3+1)<<1; (3+2)^5; (0x80000000+1)<<1 = 2 is below
    assert_eq!(log[..log.len() - 4], wanted[..wanted.len() - 4]);
    assert_eq!(log[log.len() - 4..], [8, 0, 2, DONE]);
    let stats = machine.stats();
    for (name, count) in [("EXTI0", 3), ("EXTI1", 4), ("EXTI2", 4)] {
        let interrupt = stats.interrupts.iter().find(|i| i.name == name);
        assert_eq!(interrupt.map(|i| i.count), Some(count), "{name}");
    }
    assert_eq!(stats.exceptions, 3 + 4 + 4 + 2 * 2);
}

#[test]
fn floating_point_context_survives_interrupts() {
    let (_, log) = probe::run(1, 3_000_000);
    assert_eq!(log, [0, 1, DONE], "wrong results, more than 100 ticks");
}

/// What the supervisor call of the probe and the exception that it pends log.
const SUPERVISOR_CALL: [u32; 3] = [0x200b, 0x2100, 0x100e];

/// 1 / 3 towards zero is 0x3eaaaaaa; FPSCR has its rounding mode and, behind a division, IXC (ARMv7-M, FPSCR).
#[test]
fn fpscr_survives_exceptions_whose_handlers_use_no_floating_point() {
    let (_, log) = probe::run(28, 100_000);
    let [first, second] = [SUPERVISOR_CALL; 2];
    let values = [0x3eaa_aaaa, 0x3eaa_aaaa, 0x00c0_0010, 0x00c0_0000];
    assert_eq!(log, [&first[..], &second, &values, &[DONE]].concat());
}

#[test]
fn a_flip_of_fpscr_behind_an_exception_lasts() {
    const ROUNDING: u8 = 23;
    let mut machine = probe::machine(30);
    machine.run_until(100_000).expect("runs");
    assert_eq!(probe::log(&machine), SUPERVISOR_CALL);
    machine.flip_core_bit(CoreRegister::Fpscr, ROUNDING).expect("flips");
    machine.run_until(200_000).expect("runs");
    machine.flip_core_bit(CoreRegister::R(4), 0).expect("flips");
    machine.run_until(300_000).expect("runs");
    assert_eq!(probe::log(&machine)[3..], [1 << ROUNDING, DONE]);
}

/// Of SMLAD, Q tells whether the sum with the addend overflows (ARMv7-M, SMLAD): 2 * 2^30 - 0x7fff8000 is 0x8000.
#[test]
fn smlad_leaves_q_clear_if_the_addend_brings_the_sum_back_into_range() {
    let (_, log) = probe::run(31, 100_000);
    let (sum, no_flags) = (0x8000, 0);
    assert_eq!(log, [sum, no_flags, sum, no_flags, sum, no_flags, DONE]);
}

/// Bits 1:0 of stack pointers are 0; BASEPRI has the bits of the priorities that the chip has; CONTROL has three bits (ARMv7-M, special
/// registers).
#[test]
fn special_registers_have_the_bits_of_the_architecture_only() {
    let (_, log) = probe::run(29, 100_000);
    assert_eq!(log, [0x2000_103c, 0x2000_103c, 0x30, 4, DONE]);
}

#[test]
fn a_load_without_memory_becomes_a_hard_fault() {
    let (_, log) = probe::run(2, 100_000);
    let precise_bus_fault_with_address = 1 << 9 | 1 << 15;
    assert_eq!(log[..4], [1, 3, precise_bus_fault_with_address, 1 << 30]);
    let function = probe::firmware().function_at(log[4]);
    assert!(function.contains("bad_load") || function.contains("main"), "stacked PC in {function}");
    assert_eq!(log[5], DONE);
}

#[test]
fn an_undefined_instruction_becomes_a_hard_fault() {
    let (_, log) = probe::run(3, 100_000);
    assert_eq!(log[..4], [1, 3, 1 << 16, 1 << 30]);
}

#[test]
fn a_fault_in_the_fault_handler_without_a_watchdog_ends_the_run() {
    match probe::machine(4).run_until(1_000_000).expect_err("stops") {
        Stop::Lockup { priority, place, .. } => {
            assert_eq!(priority, -1);
            assert!(place.function.contains("hard_fault"), "{place}");
        }
        other => panic!("{other}"),
    }
}

#[test]
fn the_independent_watchdog_ends_lockup() {
    let (machine, log) = probe::run(21, 1_000_000);
    assert_eq!(log[..2], [0x2e, 0x0010_cced], "flags, and RAM from before");
    let reset = probe::only_reset(&machine);
    assert_eq!(reset.cause, ResetCause::IndependentWatchdog);
    let ten_milliseconds = 160_000;
    assert!(
        (ten_milliseconds..ten_milliseconds + 5_000).contains(&reset.at),
        "10 ms after its start, soon after power-up: {reset:?}"
    );
}

#[test]
fn a_software_reset_sets_its_flag() {
    let (machine, log) = probe::run(5, 100_000);
    assert_eq!(log, [0x1e, 0, DONE], "power-on, brown-out, pin and software flags; thread mode");
    assert_eq!(probe::only_reset(&machine).cause, ResetCause::Software);
}

#[test]
fn wfe_falls_through_once_after_sev() {
    let (machine, log) = probe::run(6, 100_000);
    assert_eq!(log, [0, 1, DONE]);
    assert!(machine.now() >= 100_000);
}

#[test]
fn a_condition_ends_with_its_it_block() {
    let (_, log) = probe::run(17, 100_000);
    assert_eq!(log, [1, 1, DONE]);
}

#[test]
fn the_state_of_an_it_block_survives_interrupts() {
    let (_, log) = probe::run(18, 10_000_000);
    assert_eq!(
        log,
        [0, 1, DONE],
        "instructions that should have been skipped, more than 100 ticks"
    );
}

/// ARMv7-M C1.3: DEBUGEVT, because neither halting debug nor the debug monitor is on.
#[test]
fn a_breakpoint_without_a_debugger_becomes_a_hard_fault() {
    let (_, log) = probe::run(27, 100_000);
    assert_eq!(log[..3], [3, 0, 1 << 31]);
}

#[test]
fn under_a_debugger_a_breakpoint_halts_the_core_until_it_is_answered() {
    const MS_PS: u64 = 1_000_000_000;
    let mut machine = probe::machine(27);
    machine.restart_under_debugger().expect("restarts");
    assert_eq!(machine.run_until_halted(MS_PS), Ok(Some(Halted::Breakpoint(0xab))));
    assert_eq!(machine.call_registers(), [0x11, 0x22]);
    let executed = machine.stats().instructions;
    assert_eq!(machine.run_until_halted(2 * MS_PS), Ok(None));
    assert_eq!(machine.stats().instructions, executed, "the core stands still");
    machine.continue_behind_breakpoint(Some(0x33)).expect("continues");
    assert_eq!(machine.run_until_halted(3 * MS_PS), Ok(None));
    assert_eq!(probe::log(&machine), [0x33, 1, DONE]);
}

#[test]
fn under_a_debugger_resets_and_hard_faults_halt_the_core() {
    const MS_PS: u64 = 1_000_000_000;
    let mut machine = probe::machine(5);
    machine.restart_under_debugger().expect("restarts");
    machine.run_until_halted(MS_PS).expect("runs");
    // The case has found the debugger's own reset, and has not reset itself.
    assert_eq!(probe::log(&machine), [0x1e, 0, DONE]);
    machine.pull_reset_pin().expect("resets");
    let halted = machine.run_until_halted(2 * MS_PS);
    assert_eq!(halted, Ok(Some(Halted::Reset(ResetCause::Pin))));

    let mut machine = probe::machine(3);
    machine.restart_under_debugger().expect("restarts");
    match machine.run_until_halted(MS_PS) {
        Ok(Some(Halted::HardFault { cause, place })) => {
            assert_eq!(cause, "undefined instruction");
            assert!(place.function.contains("undefined") || place.function.contains("main"));
        }
        other => panic!("{other:?}"),
    }
}
