//! Cases of the core: exceptions, masks, stacks, floating-point context, faults, sleep.
use crate::{done, log, read, write};
use core::arch::{asm, global_asm};
use core::hint::black_box;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use cortex_m::asm::{dsb, isb, wfe, wfi};

const SYST_CSR: usize = 0xe000_e010;
const ISER0: usize = 0xe000_e100;
const ISPR0: usize = 0xe000_e200;
const IPR: usize = 0xe000_e400;
const ICSR: usize = 0xe000_ed04;
const AIRCR: usize = 0xe000_ed0c;
const SHPR2: usize = 0xe000_ed1c;
const SHPR3: usize = 0xe000_ed20;
const CFSR: usize = 0xe000_ed28;
const HFSR: usize = 0xe000_ed2c;
const RCC_CSR: usize = 0x4002_3874;

/// Three interrupts that nothing else uses: middle, high and low priority.
const MIDDLE: u32 = 6;
const HIGH: u32 = 7;
const LOW: u32 = 8;

static TICKS: AtomicU32 = AtomicU32::new(0);
static FAULT_AGAIN: AtomicU32 = AtomicU32::new(0);

pub fn ipsr() -> u32 {
    let value;
    // SAFETY: reads a special register.
    unsafe { asm!("mrs {}, ipsr", out(reg) value) };
    value
}

fn pend(interrupt: u32) {
    write(ISPR0, 1 << interrupt);
    dsb();
    isb();
}

fn mask_below(basepri: u8) {
    // SAFETY: only delays interrupts.
    unsafe { cortex_m::register::basepri::write(basepri) };
    isb();
}

fn unmask() {
    // SAFETY: the cases use no critical sections around it.
    unsafe { cortex_m::interrupt::enable() };
    isb();
}

/// Nesting, tail chaining, PRIMASK, BASEPRI, SVC, PendSV, the process stack, sleep under PRIMASK, IT blocks.
pub fn exceptions() {
    write(IPR + 4, 0x4080_0000); // interrupts 6 and 7
    write(IPR + 8, 0x0000_00c0); // 8
    write(SHPR2, 0x1000_0000);
    write(SHPR3, 0x20f0_0000);
    write(ISER0, 1 << MIDDLE | 1 << HIGH | 1 << LOW);
    log(1);
    pend(MIDDLE);
    log(2);
    cortex_m::interrupt::disable();
    pend(MIDDLE);
    log(3);
    unmask();
    log(4);
    mask_below(0x80);
    write(ISPR0, 1 << MIDDLE | 1 << HIGH);
    dsb();
    isb();
    log(5);
    mask_below(0);
    log(6);
    // SAFETY: the handler returns.
    unsafe { asm!("svc 7") };
    log(7);
    log(on_process_stack());
    cortex_m::interrupt::disable();
    pend(LOW);
    wfi();
    log(8);
    unmask();
    log(9);
    for (a, b) in [(3, 2), (2, 3), (0x8000_0000, 1)] {
        log(it_block(a, b));
    }
}

/// Calls the supervisor from thread mode on the process stack; a register of the upper floating-point half must
/// survive. Returns it, plus CONTROL.SPSEL as seen on the process stack.
fn on_process_stack() -> u32 {
    static STACK: [AtomicU32; 64] = [const { AtomicU32::new(0) }; 64];
    let top = STACK.as_ptr_range().end as usize;
    let (kept, control): (u32, u32);
    // SAFETY: SP goes back to the main stack before the block ends; the process stack is large enough for two
    // frames with floating-point state.
    unsafe {
        asm!(
            "msr psp, {top}",
            "mrs {old}, control", "orr {old}, {old}, #2", "msr control, {old}", "isb",
            "mov {kept}, #0x11", "vmov s20, {kept}",
            "svc 3",
            "vmov {kept}, s20", "mrs {control}, control",
            "bic {old}, {control}, #2", "msr control, {old}", "isb",
            top = in(reg) top & !7, old = out(reg) _, kept = out(reg) kept, control = out(reg) control,
            out("s20") _,
        );
    }
    kept | (control & 2) << 8
}

/// `a > b ? (a + 1) << 1 : (b + 2) ^ 5`, unsigned, as one IT block.
#[inline(never)]
fn it_block(a: u32, b: u32) -> u32 {
    let result;
    // SAFETY: arithmetic only.
    unsafe {
        asm!(
            "cmp {a}, {b}", "itete hi", "addhi {r}, {a}, #1", "addls {r}, {b}, #2", "lslhi {r}, {r}, #1",
            "eorls {r}, {r}, #5",
            a = in(reg) a, b = in(reg) b, r = out(reg) result,
        );
    }
    result
}

pub fn software_interrupt(interrupt: i16) {
    match interrupt as u32 {
        MIDDLE => {
            log(0x100 | ipsr());
            pend(HIGH);
            log(0x101);
            pend(LOW);
            log(0x102);
        }
        HIGH => log(0x200 | ipsr()),
        _ => log(0x300 | ipsr()),
    }
}

pub fn supervisor_call() {
    log(0x2000 | ipsr());
    write(ICSR, 1 << 28);
    dsb();
    isb();
    log(0x2100);
}

/// A computation whose intermediate results live in floating-point registers.
#[inline(never)]
fn compute(seed: f32) -> f32 {
    let mut x = seed;
    for i in 0..50u8 {
        x = x * 0.75 + f32::from(i) / (x + 2.0);
    }
    x
}

pub fn tick() {
    let count = TICKS.fetch_add(1, Relaxed);
    // SAFETY: registers are declared as changed; FPSCR is restored by the exception return.
    unsafe {
        asm!(
            "vmov s0, {n}", "vmov s1, {n}", "vmov s7, {n}", "vmov s15, {n}",
            "vmrs {t}, fpscr", "orr {t}, {t}, #0xc00000", "vmsr fpscr, {t}",
            n = in(reg) count, t = out(reg) _, out("s0") _, out("s1") _, out("s7") _, out("s15") _,
        );
    }
    black_box(compute(count as f32));
}

/// Computes in floating point while an interrupt uses every register and another rounding mode; logs the wrong results.
pub fn float_context() {
    let wanted = compute(black_box(2.5)).to_bits();
    write(SYST_CSR + 4, 4_999);
    write(SYST_CSR + 8, 0);
    write(SYST_CSR, 7);
    let wrong = (0..500).filter(|_| compute(black_box(2.5)).to_bits() != wanted).count();
    write(SYST_CSR, 0);
    log(wrong as u32);
    log(u32::from(TICKS.load(Relaxed) > 100));
}

pub fn bad_load() {
    log(1);
    read(0x6000_0000);
    log(2);
}

pub fn undefined() {
    log(1);
    cortex_m::asm::udf();
}

/// Divides 1 by 3 towards zero before and behind an exception whose handler uses no floating point; logs both results, and FPSCR
/// behind the division and behind another exception.
pub fn float_state_behind_an_exception() {
    let (before, behind, inexact, modes): (u32, u32, u32, u32);
    // SAFETY: the handler changes only what its frame restores, and memory.
    unsafe {
        asm!(
            "vmsr fpscr, {towards_zero}",
            "vmov.f32 s1, #1.0",
            "vmov.f32 s2, #3.0",
            "vdiv.f32 s0, s1, s2",
            "vmov {before}, s0",
            "svc 0",
            "vdiv.f32 s0, s1, s2",
            "vmov {behind}, s0",
            "vmrs {inexact}, fpscr",
            "vmsr fpscr, {towards_zero}",
            "svc 0",
            "vmrs {modes}, fpscr",
            "vmsr fpscr, {zero}",
            towards_zero = in(reg) 0xc0_0000, zero = in(reg) 0, before = out(reg) before, behind = out(reg) behind,
            inexact = out(reg) inexact, modes = out(reg) modes, out("s0") _, out("s1") _, out("s2") _,
        );
    }
    for word in [before, behind, inexact, modes] {
        log(word);
    }
}

// r0 = SMLAD of r1 with itself, three times, in the flash and in the RAM.
global_asm!(
    ".macro multiply name",
    ".global \\name",
    ".thumb_func",
    "\\name:",
    "smlad r0, r1, r1, r1",
    "bx lr",
    ".endm",
    ".section .text.multiply_in_flash, \"ax\", %progbits",
    "multiply multiply_in_flash",
    ".section .data.multiply_in_ram, \"aw\", %progbits",
    ".balign 4",
    "multiply multiply_in_ram",
);

unsafe extern "C" {
    fn multiply_in_flash();
    fn multiply_in_ram();
}

/// Logs SMLAD of operands of -32768 and the flags, by code in the flash, there at its other address, and in the RAM.
pub fn dual_multiplication() {
    const FLASH: usize = 0x0800_0000;
    let flash = multiply_in_flash as *const () as usize;
    for code in [flash, flash - FLASH, multiply_in_ram as *const () as usize] {
        let (sum, flags): (u32, u32);
        // SAFETY: the code changes r0 and flags.
        unsafe {
            asm!(
                "msr apsr_nzcvq, {zero}",
                "blx {code}",
                "mrs {flags}, apsr",
                code = in(reg) code, zero = in(reg) 0, flags = out(reg) flags, out("r0") sum,
                in("r1") 0x8000_8000_u32, out("lr") _,
            );
        }
        log(sum);
        log(flags);
    }
}

/// Logs PSP, SP and BASEPRI after values with bits that they do not have, and CONTROL.
pub fn special_registers() {
    let (process, main, mask, control): (u32, u32, u32, u32);
    // SAFETY: the process stack is not used; stack pointer and mask are as before at the end.
    unsafe {
        asm!(
            "msr psp, {odd}",
            "mrs {process}, psp",
            "mov {old}, sp",
            "mov sp, {odd}",
            "mov {main}, sp",
            "mov sp, {old}",
            "msr basepri, {odd}",
            "mrs {mask}, basepri",
            "msr basepri, {zero}",
            "vmov s0, {zero}",
            "mrs {control}, control",
            odd = in(reg) 0x2000_103f, zero = in(reg) 0, old = out(reg) _, process = out(reg) process, main = out(reg) main,
            mask = out(reg) mask, control = out(reg) control, out("s0") _,
        );
    }
    for word in [process, main, mask, control] {
        log(word);
    }
}

/// Behind an exception, waits without floating point until r4 has changed, and logs FPSCR.
pub fn flipped_float_state() {
    let modes: u32;
    // SAFETY: changes only its registers; the handler changes only what its frame restores, and memory.
    unsafe {
        asm!(
            "vmsr fpscr, r4",
            "svc 0",
            "2: cmp r4, #0",
            "beq 2b",
            "vmrs {modes}, fpscr",
            inout("r4") 0 => _,
            modes = out(reg) modes,
        );
    }
    log(modes);
}

/// Logs what the debugger answers to a call of operation 0x11 with parameter 0x22, and whether it is attached.
pub fn semihosting_call() {
    const DHCSR: usize = 0xe000_edf0;
    let answer: u32;
    // SAFETY: the call changes no memory, and R0 only.
    unsafe { core::arch::asm!("bkpt 0xab", inout("r0") 0x11 => answer, in("r1") 0x22) };
    log(answer);
    log(read(DHCSR) & 1);
}

pub fn lockup() {
    FAULT_AGAIN.store(1, Relaxed);
    read(0x6000_0000);
}

pub fn hard_fault(pc: u32) -> ! {
    log(ipsr());
    log(read(CFSR));
    log(read(HFSR));
    log(pc);
    if FAULT_AGAIN.load(Relaxed) != 0 {
        read(0x6000_0000);
    }
    done()
}

/// Resets itself once; after that it logs the reset flags and the exception number.
pub fn software_reset() {
    let flags = read(RCC_CSR) >> 24;
    if flags & 0x10 != 0 {
        log(flags);
        log(ipsr());
        return;
    }
    write(AIRCR, 0x05fa_0004);
    dsb();
    loop {
        cortex_m::asm::nop();
    }
}

/// WFE falls through after SEV, else sleeps until the tick.
pub fn sleep_by_events() {
    cortex_m::asm::sev();
    wfe();
    log(TICKS.load(Relaxed));
    write(SYST_CSR + 4, 9_999);
    write(SYST_CSR, 7);
    wfe();
    log(TICKS.load(Relaxed));
    write(SYST_CSR, 0);
}

/// A conditional load that is the first access to its page of memory; the two instructions of the block after it
/// have no condition. Logs 1 for the load and 1 for those.
pub fn condition_ends_with_its_block() {
    let (loaded, after): (u32, u32);
    // SAFETY: reads a word of RAM below the stack, whose value does not matter; changes only its registers.
    unsafe {
        asm!(
            "cmp r0, #1",
            "itt ne",
            "ldrne r2, [r1]",
            "movne r2, #1",
            "b 2f",
            "2: cmp r0, #0",
            "adds r3, #1",
            in("r0") 0,
            in("r1") 0x2001_0000,
            inout("r2") 0 => loaded,
            inout("r3") 0 => after,
        );
    }
    log(loaded);
    log(after);
}

/// Executes an IT block that straddles two pages and skips its instructions, under a tick; logs how many were not skipped.
pub fn condition_survives_interrupts() {
    write(SYST_CSR + 4, 9_999);
    write(SYST_CSR, 7);
    let mut run: u32 = 0;
    for _ in 0..200_000 {
        // SAFETY: changes only its registers.
        unsafe {
            asm!(
                "b.w 2f",
                ".balign 1024",
                ".space 1018",
                "2: cmp r0, #0",
                "itt ne",
                "addne r1, #1",
                "addne r1, #1",
                in("r0") 0,
                inout("r1") run,
            );
        }
    }
    write(SYST_CSR, 0);
    log(run);
    log(u32::from(TICKS.load(Relaxed) > 100));
}

/// Waits until a bit of r4 and one of s20 have changed, and logs both; then until flag Z has changed, logs 3; then until bit 4
/// of the PC has, logs 4.
pub fn waits_for_flips() {
    log(1);
    let (general, float): (u32, u32);
    // SAFETY: changes only its registers.
    unsafe {
        asm!(
            "2: cmp r4, #0",
            "beq 2b",
            "vmov s20, {float}",
            "2: vmov {float}, s20",
            "cmp {float}, #0",
            "beq 2b",
            inout("r4") 0 => general,
            float = inout(reg) 0 => float,
            out("s20") _,
        );
    }
    log(general);
    log(float);
    // SAFETY: changes only the flags.
    unsafe { asm!("cmp {r}, {r}", "2: beq 2b", r = in(reg) 0) };
    log(3);
    // SAFETY: only branches; the instruction at the flipped address is in the block.
    unsafe { asm!(".balign 32", "2: b 2b", ".balign 16", "nop") };
    log(4);
}
