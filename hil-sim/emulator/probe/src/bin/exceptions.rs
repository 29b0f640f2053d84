//! Exceptions, their priorities and frames, and faults, on nothing but CPU, NVIC and memory. Each step logs what it observes, so
//! any Cortex-M4 with flash at 0x08000000 and this RAM can run it and be compared.
#![no_std]
#![no_main]

use core::arch::{asm, global_asm};
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use cortex_m::asm::{dsb, isb};
use cortex_m_rt::entry;

#[path = "../sleep_on_panic.rs"]
mod sleep_on_panic;

/// Entries of the log.
const ENTRIES: usize = 4000;

/// Observations in order. The first word is the number of entries.
#[unsafe(no_mangle)]
pub static LOG: [AtomicU32; ENTRIES + 1] = [const { AtomicU32::new(0) }; ENTRIES + 1];
/// 1 at the end.
#[unsafe(no_mangle)]
pub static FINISHED: AtomicU32 = AtomicU32::new(0);
/// Address at which the program continues after a fault.
#[unsafe(no_mangle)]
static RESUME: AtomicU32 = AtomicU32::new(0);
/// Stack pointer before a supervisor call; 0 if its frame is not to be logged.
#[unsafe(no_mangle)]
static STACK_BEFORE: AtomicU32 = AtomicU32::new(0);
/// What the handler of an interrupt does.
static ACTION: AtomicU32 = AtomicU32::new(0);

/// The vector table; 512 bytes of alignment for 113 vectors.
#[repr(C, align(512))]
struct Vectors([AtomicU32; 128]);
static VECTORS: Vectors = Vectors([const { AtomicU32::new(0) }; 128]);

#[repr(C, align(8))]
struct Stack([AtomicU32; 128]);
static PROCESS_STACK: Stack = Stack([const { AtomicU32::new(0) }; 128]);

const CPACR: usize = 0xe000_ed88;
const ICSR: usize = 0xe000_ed04;
const VTOR: usize = 0xe000_ed08;
const AIRCR: usize = 0xe000_ed0c;
const CCR: usize = 0xe000_ed14;
const SHPR2: usize = 0xe000_ed1c;
const SHPR3: usize = 0xe000_ed20;
const SHCSR: usize = 0xe000_ed24;
const CFSR: usize = 0xe000_ed28;
const HFSR: usize = 0xe000_ed2c;
const FAULT_ADDRESS: usize = 0xe000_ed38;
const ISER0: usize = 0xe000_e100;
const ICER0: usize = 0xe000_e180;
const ISPR0: usize = 0xe000_e200;
const ICPR0: usize = 0xe000_e280;
const IABR0: usize = 0xe000_e300;
const IPR1: usize = 0xe000_e404;
const IPR2: usize = 0xe000_e408;
const STIR: usize = 0xe000_ef00;

/// Interrupts without a source here.
const FIRST: u32 = 6;
const SECOND: u32 = 7;
const THIRD: u32 = 8;

fn log(word: u32) {
    let used = LOG[0].fetch_add(1, Relaxed) as usize;
    if let Some(entry) = LOG.get(used + 1) {
        entry.store(word, Relaxed);
    }
}

fn read(address: usize) -> u32 {
    // SAFETY: the address is that of a register, or has no memory where a fault is intended; no Rust object is there.
    unsafe { (address as *const u32).read_volatile() }
}

fn write(address: usize, value: u32) {
    // SAFETY: as in `read`.
    unsafe { (address as *mut u32).write_volatile(value) }
    dsb();
    isb();
}

// Every exception: its frame and EXC_RETURN go to `dispatch`, which tells the value to return by.
global_asm!(
    ".section .text.handler, \"ax\", %progbits",
    ".global handler",
    ".thumb_func",
    "handler:",
    "tst lr, #4",
    "ite eq",
    "mrseq r0, msp",
    "mrsne r0, psp",
    "mov r1, lr",
    "push {{r3, lr}}",
    "bl dispatch",
    "pop {{r3, lr}}",
    "bx r0",
);

// Handlers that make no exclusive access, and that leave the monitor set, of the address in r1.
global_asm!(
    ".section .text.handler, \"ax\", %progbits",
    ".global does_nothing",
    ".thumb_func",
    "does_nothing:",
    "bx lr",
    ".global leaves_the_monitor_set",
    ".thumb_func",
    "leaves_the_monitor_set:",
    "ldrex r2, [r1]",
    "bx lr",
);

unsafe extern "C" {
    fn handler();
    fn does_nothing();
    fn leaves_the_monitor_set();
}

fn special(name: u32) -> u32 {
    let value: u32;
    // SAFETY: reads special registers.
    unsafe {
        match name {
            0 => asm!("mrs {}, ipsr", out(reg) value),
            1 => asm!("mrs {}, control", out(reg) value),
            2 => asm!("mrs {}, basepri", out(reg) value),
            3 => asm!("mrs {}, primask", out(reg) value),
            _ => asm!("mrs {}, faultmask", out(reg) value),
        }
    }
    value
}
const IPSR: u32 = 0;
const CONTROL: u32 = 1;
const BASEPRI: u32 = 2;
const PRIMASK: u32 = 3;
const FAULTMASK: u32 = 4;

#[unsafe(no_mangle)]
extern "C" fn dispatch(frame: *mut [u32; 8], exc_return: u32) -> u32 {
    let exception = special(IPSR);
    log(0xe0e0_0000 | exception);
    log(exc_return);
    log(read(ICSR) & 0xfff);
    let mut return_by = exc_return;
    match exception {
        3..=6 => {
            if read(CFSR) & 1 << 18 != 0 {
                return_by = 0xffff_fff9; // an invalid EXC_RETURN stays in LR
            }
            fault(frame);
        }
        11 => match supervisor_call(frame) {
            5 => return_by = 0xffff_fff5, // no valid EXC_RETURN
            7 => return_by = 0xffff_fffd, // to the process stack
            _ => {}
        },
        22 => first(),
        _ => {}
    }
    log(0xe1e1_0000 | exception);
    return_by
}

/// Logs a fault, and continues at `RESUME`.
fn fault(frame: *mut [u32; 8]) {
    let status = read(CFSR);
    log(status);
    log(read(HFSR));
    if status & 0x8080 != 0 {
        log(read(FAULT_ADDRESS));
    }
    write(CFSR, u32::MAX);
    write(HFSR, u32::MAX);
    // SAFETY: the frame of this exception, to which no reference exists.
    let frame = unsafe { &mut *frame };
    frame[6] = if frame[7] & 0x1ff == 0 {
        RESUME.load(Relaxed) & !1
    } else {
        handler as *const () as u32 & !1 // the vector had no Thumb bit
    };
    frame[7] = frame[7] & !0x0600_fc00 | 1 << 24;
}

/// A handler that uses the floating-point unit. Not inlined, so that no other handler saves its registers.
#[inline(never)]
fn use_float() {
    let (modes, kept): (u32, u32);
    // SAFETY: a frame keeps what the handler changes.
    unsafe {
        asm!(
            "vmrs {modes}, fpscr", "vmov {kept}, s5", "vmov s5, {modes}", "vmov s20, {modes}",
            modes = out(reg) modes, kept = out(reg) kept, out("s5") _, out("s20") _,
        );
    }
    log(modes);
    log(kept);
    log(special(CONTROL));
}

/// Returns the number of the call.
fn supervisor_call(frame: *mut [u32; 8]) -> u8 {
    let stacked = match STACK_BEFORE.swap(0, Relaxed) {
        0 => 0,
        before => before - frame as u32,
    };
    log(stacked);
    // SAFETY: as in `fault`; the instruction before the return address is in the flash.
    let (number, psr) = unsafe {
        let pc = (*frame)[6];
        (((pc - 2) as *const u8).read(), (*frame)[7])
    };
    log(u32::from(number));
    log(psr & 0xf800_03ff);
    match number {
        1 => use_float(),
        2 => write(ISPR0, 1 << SECOND | 1 << THIRD),
        3 => {
            // SAFETY: ends with this exception.
            unsafe { asm!("cpsid f") };
            log(special(FAULTMASK));
        }
        // SAFETY: the frame has no Thumb bit now, which is the fault to be taken.
        4 => unsafe { (*frame)[7] &= !(1 << 24) },
        6 => {
            // SAFETY: raises the privilege of the caller.
            unsafe { asm!("mrs {r}, control", "bic {r}, #1", "msr control, {r}", r = out(reg) _) };
        }
        7 => {
            // SAFETY: the frame is without floating-point state; the process stack is not used.
            unsafe {
                let copy = PROCESS_STACK.0.as_ptr().cast_mut().cast::<[u32; 8]>().add(2);
                copy.write(*frame);
                asm!(
                    "msr psp, {copy}", "mrs {r}, control", "orr {r}, #1", "msr control, {r}",
                    copy = in(reg) copy, r = out(reg) _,
                );
            }
            log(special(CONTROL));
        }
        _ => {}
    }
    number
}

fn first() {
    match ACTION.load(Relaxed) {
        1 => write(ISPR0, 1 << SECOND | 1 << THIRD),
        2 => {
            write(ISPR0, 1 << SECOND);
            write(IPR1, 0x1050_0000); // the second becomes more urgent
            log(1);
        }
        3 => {
            // SAFETY: nothing depends on the mask.
            unsafe { cortex_m::register::basepri::write(0x20) };
            write(ISPR0, 1 << SECOND);
            log(2);
            // SAFETY: as above.
            unsafe { cortex_m::register::basepri::write(0) };
            isb();
        }
        4 => {
            write(ISPR0, 1 << FIRST);
            ACTION.store(0, Relaxed);
        }
        5 => log(read(IABR0)),
        _ => {}
    }
    log(read(ICSR) & 0x9f40_f000);
}

/// Interrupts with priorities, pended by `set`.
fn interrupts(step: u32, group: u32, priorities: [u32; 3], action: u32, set: u32) {
    log(0xa000_0000 | step);
    write(AIRCR, 0x05fa_0000 | group << 8);
    log(read(AIRCR));
    write(IPR1, priorities[0] << 16 | priorities[1] << 24);
    write(IPR2, priorities[2]);
    write(ISER0, 1 << FIRST | 1 << SECOND | 1 << THIRD);
    ACTION.store(action, Relaxed);
    write(ISPR0, set);
    log(read(ISPR0));
}

fn priorities() {
    let mut step = 0;
    for group in [0, 3, 4, 5, 6, 7] {
        for levels in [[0x80, 0x40, 0xc0], [0x50, 0x40, 0x60], [0x40, 0x40, 0x40]] {
            for action in 1..6 {
                interrupts(step, group, levels, action, 1 << FIRST);
                step += 1;
            }
            interrupts(step, group, levels, 0, 1 << THIRD | 1 << SECOND | 1 << FIRST);
            step += 1;
        }
    }
    write(AIRCR, 0x05fa_0500);
    for mask in [0x10, 0x3f, 0x40, 0x50, 0x80, 0xf0] {
        // SAFETY: nothing depends on the mask.
        unsafe { cortex_m::register::basepri::write(mask) };
        log(special(BASEPRI) & 0xf0);
        interrupts(step, 5, [0x40, 0x50, 0x60], 0, 1 << THIRD | 1 << SECOND | 1 << FIRST);
        // SAFETY: as above.
        unsafe { cortex_m::register::basepri::write(0) };
        isb();
        log(read(ISPR0));
        step += 1;
    }
    cortex_m::interrupt::disable();
    log(special(PRIMASK));
    write(ISPR0, 1 << FIRST | 1 << SECOND);
    log(read(ICSR) & 0x9f40_f000);
    write(ICPR0, 1 << FIRST);
    write(ICER0, 1 << SECOND);
    // SAFETY: the program has no critical section.
    unsafe { cortex_m::interrupt::enable() };
    isb();
    log(read(ISPR0));
    write(ICPR0, 1 << SECOND);
    write(STIR, THIRD);
    write(ICSR, 1 << 28);
    write(AIRCR, 0x05fa_0000);
    write(AIRCR, 0x0000_0700); // without the key, ignored
    log(read(AIRCR));
}

macro_rules! supervisor_call {
    ($number:literal) => {
        // SAFETY: the handler changes only what its frame restores, and memory.
        unsafe {
            asm!(
                "str sp, [{before}]",
                "cmp {before}, {before}",
                concat!("svc ", $number),
                before = in(reg) STACK_BEFORE.as_ptr(),
            )
        }
    };
}

fn supervisor_calls() {
    log(0xb000_0000);
    supervisor_call!(0);
    write(SHPR2, 0x4000_0000);
    write(SHPR3, 0x2080_0000);
    write(IPR1, 0x3050_0000);
    supervisor_call!(2);
    supervisor_call!(3);
    log(special(FAULTMASK));
    // a stack pointer that is not a multiple of 8
    // SAFETY: the stack pointer is as before at the end.
    unsafe {
        asm!(
            "mov {old}, sp", "mov {t}, sp", "bic {t}, #7", "sub {t}, #12", "mov sp, {t}",
            "str sp, [{before}]", "cmp {before}, {before}", "svc 0",
            "mov sp, {old}",
            before = in(reg) STACK_BEFORE.as_ptr(), old = out(reg) _, t = out(reg) _,
        )
    }
    // floating-point frames, from the main stack and from the process stack
    for process in [0, 2] {
        let (kept, modes, after): (u32, u32, u32);
        // SAFETY: the stack is large enough for the frames; SP is as before at the end.
        unsafe {
            asm!(
                "msr psp, {top}",
                "mrs {t}, control", "orr {t}, {process}", "msr control, {t}", "isb",
                "mov {t}, #0xc00000", "vmsr fpscr, {t}", "vmov s5, {top}", "mov {t}, #77", "vmov s5, {t}",
                "str sp, [{before}]", "cmp {before}, {before}", "svc 1",
                "vmov {kept}, s5", "vmrs {modes}, fpscr", "mrs {after}, control",
                "bic {t}, {after}, #2", "msr control, {t}", "isb",
                "mov {t}, #0", "vmsr fpscr, {t}",
                top = in(reg) PROCESS_STACK.0.as_ptr_range().end, process = in(reg) process,
                before = in(reg) STACK_BEFORE.as_ptr(), t = out(reg) _, kept = out(reg) kept,
                modes = out(reg) modes, after = out(reg) after, out("s5") _, out("s20") _,
            )
        }
        log(kept);
        log(modes);
        log(after);
    }
    // the context is no longer that of a program that uses the floating-point unit
    // SAFETY: the values of its registers are not needed any more.
    unsafe { asm!("mrs {t}, control", "bic {t}, #4", "msr control, {t}", "isb", t = out(reg) _) };
    supervisor_call!(0);
}

/// Modes, flags and results of the floating-point unit before and behind an exception.
fn float_state() {
    macro_rules! divide {
        ($step:literal, $($exception:literal),+) => {{
            log(0xb000_0000 | $step);
            let (before, behind, flags, control): (u32, u32, u32, u32);
            // SAFETY: the handlers change only what their frames restore, and memory.
            unsafe {
                asm!(
                    "mov {t}, #0xc00000", "vmsr fpscr, {t}", "vmov.f32 s1, #1.0", "vmov.f32 s2, #3.0",
                    "vdiv.f32 s0, s1, s2", "vmov {before}, s0", "vmsr fpscr, {t}",
                    "str sp, [{stack}]", "cmp {stack}, {stack}", $($exception),+,
                    "vmrs {flags}, fpscr", "vdiv.f32 s0, s1, s2", "vmov {behind}, s0", "mrs {control}, control",
                    "mov {t}, #0", "vmsr fpscr, {t}",
                    before = out(reg) before, behind = out(reg) behind, flags = out(reg) flags, control = out(reg) control,
                    t = out(reg) _, stack = in(reg) STACK_BEFORE.as_ptr(), out("s0") _, out("s1") _, out("s2") _,
                )
            }
            for word in [before, behind, flags, control] {
                log(word);
            }
        }};
    }
    divide!(1, "svc 0");
    divide!(2, "svc 1");
    divide!(3, "svc 2");
    divide!(4, "svc 0", "svc 0");
    divide!(
        5,
        "mrs {t}, control",
        "bic {t}, #4",
        "msr control, {t}",
        "isb",
        "orr {t}, #4",
        "msr control, {t}",
        "isb"
    );
    divide!(6, "mov {t}, #4", "msr control, {t}", "isb", "svc 0");
    divide!(7, "mov {t}, #0", "msr control, {t}", "isb", "svc 0");
}

/// Frames at stack pointers that are no multiple of 8, with CCR.STKALIGN and without, and stack pointers that are no multiple
/// of 4.
fn stack_alignment() {
    log(0xb000_0008);
    for stkalign in [1 << 9, 0] {
        write(CCR, stkalign);
        log(read(CCR) & 1 << 9);
        for offset in [8, 12] {
            let moved: u32;
            // SAFETY: the stack pointer is as before at the end; no floating-point state is needed.
            unsafe {
                asm!(
                    "mrs {t}, control", "bic {t}, #4", "msr control, {t}", "isb",
                    "mov {old}, sp", "mov {t}, sp", "bic {t}, #7", "sub {t}, {offset}", "mov sp, {t}",
                    "str sp, [{before}]", "cmp {before}, {before}", "svc 0",
                    "mov {moved}, sp", "sub {moved}, {t}", "mov sp, {old}",
                    before = in(reg) STACK_BEFORE.as_ptr(), offset = in(reg) offset, moved = out(reg) moved,
                    old = out(reg) _, t = out(reg) _,
                )
            }
            log(moved);
        }
    }
    write(CCR, 1 << 9);
    for value in [0x2000_1000, 0x2000_1001, 0x2000_1002, 0x2000_1003_u32] {
        let (process, main): (u32, u32);
        // SAFETY: the process stack is not used; the stack pointer is as before at the end.
        unsafe {
            asm!(
                "msr psp, {value}", "mrs {process}, psp",
                "mov {old}, sp", "mov sp, {value}", "mov {main}, sp", "mov sp, {old}",
                value = in(reg) value, process = out(reg) process, main = out(reg) main, old = out(reg) _,
            )
        }
        log(process);
        log(main);
    }
}

/// Executes code that faults, and continues behind it.
macro_rules! faults {
    ($step:literal, $($code:literal),+ $(, $name:ident = $value:expr)*) => {{
        log(0xc000_0000 | $step);
        // SAFETY: the handler continues behind the code; all registers that it may change are declared.
        unsafe {
            asm!(
                "adr r2, 99f", "str r2, [r3]",
                $($code),+,
                ".balign 4", "99:",
                $($name = in(reg) $value,)*
                in("r3") RESUME.as_ptr(), out("r0") _, out("r1") _, out("r2") _, out("r12") _, out("lr") _,
                out("s0") _, out("s1") _,
            )
        }
        log(special(IPSR));
    }};
}

fn faults() {
    static DATA: [AtomicU32; 8] = [const { AtomicU32::new(0x4770) }; 8]; // bx lr
    let aligned = DATA.as_ptr() as u32;
    for enabled in [0, 0x7_0000] {
        write(SHCSR, enabled);
        faults!(1, "udf #0");
        faults!(2, "ldr r0, [{p}]", p = 0x6000_0000_u32);
        faults!(3, "str r0, [{p}]", p = 0x6000_0000_u32);
        faults!(4, "bx {p}", p = 0x0800_0400_u32);
        faults!(5, "bx {p}", p = aligned);
        faults!(6, "blx {p}", p = aligned);
        faults!(7, "bx {p}", p = 0x4000_0001_u32);
        faults!(8, "bx {p}", p = 0x6000_0001_u32);
        faults!(9, "bx {p}", p = 0xe000_0001_u32);
        faults!(10, "bx {p}", p = 0xffff_fff9_u32);
        faults!(11, "ldr pc, [{p}, #4]", p = aligned);
        faults!(12, "cmp r3, r3", ".balign 4", "nop", "svc 4");
        faults!(13, "cmp r3, r3", "svc 5");
        faults!(14, "cpsid i", "svc 0", "cpsie i");
        write(CPACR, 0);
        // The emulated machine denies whole blocks of straight code.
        faults!(16, "b 98f", "98:", "vadd.f32 s0, s0, s1");
        faults!(17, "b 98f", "98:", "vldr s0, [{p}]", p = aligned);
        write(CPACR, 0xf0_0000);
        // the mask of configurable faults
        faults!(18, "cpsid i", "udf #0");
        // SAFETY: the program has no critical section.
        unsafe { cortex_m::interrupt::enable() };
        // a vector without the Thumb bit
        write(ISER0, 1 << THIRD);
        VECTORS.0[16 + THIRD as usize].store(handler as *const () as u32 & !1, Relaxed);
        faults!(19, "str {bit}, [{p}]", "dsb", "isb", p = ISPR0, bit = 1u32 << THIRD);
        VECTORS.0[16 + THIRD as usize].store(handler as *const () as u32, Relaxed);
    }
    log(read(SHCSR));
}

/// Accesses that are not aligned. Single loads and stores are allowed.
fn alignment() {
    static DATA: [AtomicU32; 16] = [const { AtomicU32::new(0x1234_5678) }; 16];
    let aligned = DATA.as_ptr() as u32;
    write(SHCSR, 0x7_0000);
    for offset in 0..4 {
        log(0xd000_0000 | offset);
        let p = aligned + offset;
        faults!(
            1,
            "ldr r0, [{p}]",
            "str r0, [{p}, #8]",
            "ldrh r0, [{p}, #1]",
            "strh r0, [{p}, #5]",
            p = p
        );
        faults!(2, "ldm {p}, {{r0, r1}}", p = p);
        faults!(3, "stm {p}, {{r0, r1}}", p = p);
        faults!(4, "ldmdb {p}, {{r0, r1}}", p = p + 16);
        faults!(5, "ldrd r0, r1, [{p}, #4]", p = p);
        faults!(6, "strd r0, r1, [{p}, #4]", p = p);
        faults!(7, "vldr s0, [{p}]", p = p);
        faults!(8, "vstr s0, [{p}]", p = p);
        faults!(9, "vldmia {p}, {{s0, s1}}", p = p);
        faults!(10, "vstmia {p}, {{s0, s1}}", p = p);
        faults!(11, "vldr d0, [{p}, #8]", p = p);
        faults!(12, "ldrex r0, [{p}]", "clrex", p = p);
        faults!(13, "ldrexh r0, [{p}]", "clrex", p = p);
        faults!(14, "ldrexb r0, [{p}]", "clrex", p = p);
    }
}

/// The exclusive monitor, over exceptions.
fn exclusive_monitor() {
    static DATA: AtomicU32 = AtomicU32::new(5);
    log(0xf000_0000);
    for between in 0..5 {
        let failed: u32;
        // SAFETY: the handlers change nothing that is not declared; the value is not used elsewhere.
        unsafe {
            match between {
                0 => {
                    asm!("ldrex {t}, [{p}]", "strex {f}, {t}, [{p}]", p = in(reg) DATA.as_ptr(), t = out(reg) _, f = out(reg) failed)
                }
                1 => {
                    asm!("ldrex {t}, [{p}]", "cmp {p}, {p}", "svc 0", "strex {f}, {t}, [{p}]", p = in(reg) DATA.as_ptr(), t = out(reg) _, f = out(reg) failed)
                }
                2 => {
                    asm!("ldrex {t}, [{p}]", "str {bit}, [{r}]", "dsb", "isb", "strex {f}, {t}, [{p}]",
                    p = in(reg) DATA.as_ptr(), t = out(reg) _, f = out(reg) failed, bit = in(reg) 1u32 << FIRST, r = in(reg) ISPR0)
                }
                3 => {
                    asm!("ldrex {t}, [{p}]", "clrex", "strex {f}, {t}, [{p}]", p = in(reg) DATA.as_ptr(), t = out(reg) _, f = out(reg) failed)
                }
                _ => {
                    asm!("strex {f}, {t}, [{p}]", p = in(reg) DATA.as_ptr(), t = in(reg) 9, f = out(reg) failed)
                }
            }
        }
        log(failed);
        log(DATA.load(Relaxed));
    }
    let pend_sv = &VECTORS.0[14];
    for (entered, loads) in
        [(does_nothing as *const (), true), (leaves_the_monitor_set as *const (), false)]
    {
        pend_sv.store(entered as u32, Relaxed);
        let failed: u32;
        // SAFETY: as above; the handler reads the word at r1.
        unsafe {
            asm!(
                "cbz {loads}, 2f", "ldrex {t}, [r1]", "2:",
                "str {bit}, [{r}]", "dsb", "isb", "strex {f}, {t}, [r1]",
                in("r1") DATA.as_ptr(), t = inout(reg) 5 => _, f = out(reg) failed, r = in(reg) ICSR,
                bit = in(reg) 1u32 << 28, loads = in(reg) u32::from(loads),
            )
        }
        log(failed);
    }
    pend_sv.store(handler as *const () as u32, Relaxed);
}

/// Thread mode without privilege.
fn unprivileged() {
    log(0x9000_0000);
    write(SHCSR, 0x7_0000);
    let drop_privilege = || {
        // SAFETY: the supervisor call 6 raises it again.
        unsafe {
            asm!("mrs {r}, control", "orr {r}, #1", "msr control, {r}", "isb", r = out(reg) _)
        };
    };
    drop_privilege();
    log(special(CONTROL) & 1);
    // The emulated machine takes faults of register accesses at the end of straight code.
    faults!(1, "ldr r0, [{p}]", "b 98f", "98:", p = CPACR);
    faults!(2, "str r0, [{p}]", "b 98f", "98:", p = VTOR);
    faults!(3, "cpsid i", "mov r0, #0", "msr basepri, r0");
    log(special(PRIMASK));
    supervisor_call!(6);
    log(special(CONTROL) & 1);
    // the masks hold without privilege, too
    log(0x9000_0001);
    write(SHPR2, 0x2000_0000);
    write(IPR2, 0x60);
    // SAFETY: nothing depends on the mask.
    unsafe { cortex_m::register::basepri::write(0x40) };
    write(ISER0, 1 << THIRD);
    write(ISPR0, 1 << THIRD);
    drop_privilege();
    log(special(CONTROL) & 1);
    supervisor_call!(6);
    log(1);
    // SAFETY: as above.
    unsafe { cortex_m::register::basepri::write(0) };
    isb();
    log(2);
    // exceptions from the process stack, and handlers that do not inherit the floating-point context
    log(0x9000_0002);
    let (modes, control): (u32, u32);
    // SAFETY: the stack is large enough for the frames; SP, privilege and modes are as before at the end.
    unsafe {
        asm!(
            "msr psp, {top}", "mov {t}, #0xc00000", "vmsr fpscr, {t}",
            "mrs {t}, control", "orr {t}, #3", "msr control, {t}", "isb",
            "str sp, [{before}]", "cmp {before}, {before}", "svc 1",
            "cmp {before}, {before}", "svc 2",
            "vmrs {modes}, fpscr", "mrs {control}, control",
            "cmp {before}, {before}", "svc 6",
            "mrs {t}, control", "bic {t}, #2", "msr control, {t}", "isb", "mov {t}, #0", "vmsr fpscr, {t}",
            top = in(reg) PROCESS_STACK.0.as_ptr_range().end, before = in(reg) STACK_BEFORE.as_ptr(), t = out(reg) _,
            modes = out(reg) modes, control = out(reg) control, out("s5") _, out("s20") _,
        )
    }
    log(modes);
    log(control);
    // a handler takes privilege and changes the stack
    log(0x9000_0003);
    let (control, moved): (u32, u32);
    // SAFETY: as above.
    unsafe {
        asm!(
            "mrs {t}, control", "bic {t}, #4", "msr control, {t}", "isb", "mov {old}, sp",
            "cmp {old}, {old}", "svc 7",
            "mrs {control}, control", "mov {moved}, sp", "cmp {old}, {old}", "svc 6",
            "mrs {t}, control", "bic {t}, #2", "msr control, {t}", "isb", "mov sp, {old}",
            t = out(reg) _, old = out(reg) _, control = out(reg) control, moved = out(reg) moved,
        )
    }
    log(control);
    log(moved - PROCESS_STACK.0.as_ptr() as u32);
}

#[entry]
fn main() -> ! {
    for vector in &VECTORS.0 {
        vector.store(handler as *const () as u32, Relaxed);
    }
    write(VTOR, VECTORS.0.as_ptr() as u32);
    write(CPACR, 0xf0_0000);
    priorities();
    supervisor_calls();
    float_state();
    stack_alignment();
    exclusive_monitor();
    faults();
    alignment();
    unprivileged();
    for address in [SHPR2, IPR1] {
        write(address, u32::MAX);
        log(read(address) & 0xf0f0_f0f0);
    }
    FINISHED.store(1, Relaxed);
    loop {
        cortex_m::asm::wfi();
    }
}
