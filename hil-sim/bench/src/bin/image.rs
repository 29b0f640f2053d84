//! The image that is measured on the emulated microcontroller. The levels of port C's pins select the job. Each call is
//! made by the handler of PendSV, whose instructions and cycles the emulator counts.
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
/// Checksum of the values that the calls returned, low word first. Read from outside only.
#[used]
static CHECKSUM: [AtomicU32; 2] = [const { AtomicU32::new(0) }; 2];

const DONE_WELL: u32 = 1;
const DONE_BADLY: u32 = 2;

const AHB1ENR: usize = 0x4002_3830;
const GPIOC_IDR: usize = 0x4002_0810;

/// The call that the handler makes, and its result.
struct Measurement {
    work: Option<Work>,
    station: Option<Station>,
    value: Option<Value>,
    set_point: u32,
}

/// One call.
enum Work {
    Kernel(Call, Input),
    Scene(Scene, u32),
}

static MEASUREMENT: Mutex<RefCell<Measurement>> =
    Mutex::new(RefCell::new(Measurement { work: None, station: None, value: None, set_point: 0 }));

#[exception]
fn PendSV() {
    free(|section| {
        let measurement = &mut *MEASUREMENT.borrow(section).borrow_mut();
        match &measurement.work {
            Some(Work::Kernel(call, input)) => measurement.value = Some(call.on(input)),
            Some(Work::Scene(scene, tick)) => {
                if let Some(station) = &mut measurement.station {
                    measurement.set_point = (scene.step)(station, *tick);
                }
            }
            None => {}
        }
    });
}

/// Has the handler do `work` and returns the bits of the result.
fn measure(work: Work) -> u64 {
    free(|section| MEASUREMENT.borrow(section).borrow_mut().work = Some(work));
    SCB::set_pendsv();
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
    free(|section| {
        let measurement = MEASUREMENT.borrow(section).borrow();
        match (&measurement.work, &measurement.station) {
            (Some(Work::Scene(scene, _)), Some(station)) => {
                station.set_point_c(scene.arithmetic, measurement.set_point).to_bits()
            }
            _ => measurement.value.map_or(0, Value::to_bits),
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
            free(|section| MEASUREMENT.borrow(section).borrow_mut().station = Some(station));
            for tick in 1..=TICKS {
                checksum.add(measure(Work::Scene(scene, tick)));
            }
        }
    }
    Some(checksum)
}

/// Levels of port C's pins.
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
