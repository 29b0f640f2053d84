//! The image that measures on the emulated microcontroller. The level of port C's pins selects the job. Each call is
//! made by the handler of PendSV, whose instructions and cycles the machine counts.
#![no_std]
#![no_main]

use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

use cortex_m::interrupt::{Mutex, free};
use cortex_m::peripheral::SCB;
use cortex_m_rt::{entry, exception};
use model_bench::inputs::Input;
use model_bench::job::{Checksum, Job, ON_TARGET};
use model_bench::kernels::{Call, Value};
use model_bench::scenes::{Scene, Station, TICKS};

/// 0 until the job is done, then [`DONE_WELL`] or [`DONE_BADLY`]. Read from outside only.
#[used]
static DONE: AtomicU32 = AtomicU32::new(0);
/// What the calls returned, low word first. Read from outside only.
#[used]
static CHECKSUM: [AtomicU32; 2] = [const { AtomicU32::new(0) }; 2];

const DONE_WELL: u32 = 1;
const DONE_BADLY: u32 = 2;

const AHB1ENR: usize = 0x4002_3830;
const GPIOC_IDR: usize = 0x4002_0810;

/// What the handler is to call, and what that returned.
struct Desk {
    work: Option<Work>,
    station: Option<Station>,
    value: Option<Value>,
    set_point: u32,
}

enum Work {
    Kernel(Call, Input),
    Scene(Scene, u32),
}

static DESK: Mutex<RefCell<Desk>> = Mutex::new(RefCell::new(Desk {
    work: None,
    station: None,
    value: None,
    set_point: 0,
}));

#[exception]
fn PendSV() {
    free(|section| {
        let desk = &mut *DESK.borrow(section).borrow_mut();
        match &desk.work {
            Some(Work::Kernel(call, input)) => desk.value = Some(call.on(input)),
            Some(Work::Scene(scene, tick)) => {
                if let Some(station) = &mut desk.station {
                    desk.set_point = (scene.step)(station, *tick);
                }
            }
            None => {}
        }
    });
}

/// Has the handler do `work` and returns the bits of the answer.
fn measure(work: Work) -> u64 {
    free(|section| DESK.borrow(section).borrow_mut().work = Some(work));
    SCB::set_pendsv();
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
    free(|section| {
        let desk = DESK.borrow(section).borrow();
        match (&desk.work, &desk.station) {
            (Some(Work::Scene(scene, _)), Some(station)) => station
                .set_point_c(scene.arithmetic, desk.set_point)
                .to_bits(),
            _ => desk.value.map_or(0, Value::to_bits),
        }
    })
}

fn run(job: Job) -> Option<Checksum> {
    let mut checksum = Checksum::default();
    match job {
        Job::Kernel(call) => {
            for index in 0..ON_TARGET {
                checksum.add(measure(Work::Kernel(call, Input::nth(index)?)));
            }
        }
        Job::Scene(scene) => {
            let station = Station::new().ok()?;
            free(|section| DESK.borrow(section).borrow_mut().station = Some(station));
            for tick in 1..=TICKS {
                checksum.add(measure(Work::Scene(scene, tick)));
            }
        }
    }
    Some(checksum)
}

/// Level of port C's pins.
fn selection() -> u32 {
    // SAFETY: registers of the clock controller and of port C, read and written whole; nothing else uses them.
    unsafe {
        let enable = AHB1ENR as *mut u32;
        enable.write_volatile(enable.read_volatile() | 1 << 2);
        (GPIOC_IDR as *const u32).read_volatile()
    }
}

#[entry]
fn main() -> ! {
    match Job::selected(selection()).and_then(run) {
        Some(Checksum(sum)) => {
            CHECKSUM[0].store(sum as u32, Relaxed);
            CHECKSUM[1].store((sum >> 32) as u32, Relaxed);
            DONE.store(DONE_WELL, Relaxed);
        }
        None => DONE.store(DONE_BADLY, Relaxed),
    }
    loop {
        cortex_m::asm::wfi();
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    DONE.store(DONE_BADLY, Relaxed);
    loop {
        cortex_m::asm::wfi();
    }
}
