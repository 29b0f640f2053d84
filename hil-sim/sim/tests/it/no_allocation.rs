//! Stepping the plant and the native engine allocates nothing: counted in the allocator.
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;

use contact_model::material::find;
use thermal_plant::bridge::{BridgeOutputs, Leg};
use thermal_plant::finger::FingerParams;
use thermal_plant::object::ObjectConfig;
use thermal_plant::sensors::Channel;
use thermal_plant::{Params, Plant, PlantConfig};
use thermal_sim::World;
use thermal_sim::engine::{Engine, NativeEngine};
use thermal_sim::scene::Scene;

thread_local! {
    /// Calls of the allocator by this thread: tests run side by side.
    static CALLS: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    CALLS.with(|calls| calls.set(calls.get() + 1));
}

struct Counting;

// SAFETY: every call is handed on to the system's allocator as it came; counting neither allocates nor unwinds, as the
// counter has neither a lazy start nor a destructor.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promise is the same.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promise is the same.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller's promise is the same, and all memory is the system allocator's.
        unsafe { System.realloc(old, layout, size) }
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        count();
        // SAFETY: the caller's promise is the same, and all memory is the system allocator's.
        unsafe { System.dealloc(old, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Calls of the allocator that `work` makes.
fn calls_of(work: impl FnOnce()) -> u64 {
    let before = CALLS.get();
    work();
    CALLS.get() - before
}

/// Force over 1.2 s, N: lifted, landed, up and down slowly, a jump, lifted, landed again.
fn force_n(ms: u32) -> f64 {
    match ms {
        0..100 => 0.0,
        100..200 => 0.2,
        200..600 => 0.2 + 0.005 * f64::from(ms - 200),
        600..700 => 0.5,
        700..900 => 0.0,
        _ => 1.0,
    }
}

const RUN_MS: u32 = 1200;

fn plant(finger: FingerParams) -> Plant {
    let params = Params { finger, ..Params::nominal() };
    let copper = *find("copper").expect("a material of the thesis");
    Plant::new(&PlantConfig {
        skin_c: 34.0,
        room_c: 24.0,
        object: ObjectConfig::half_space(copper, 24.0),
        start_s: -0.05,
        appears_s: 0.0,
        duration_s: 2.0,
        seed: 1,
        params,
    })
    .expect("a sound configuration")
}

#[test]
fn allocator_counts() {
    let mut kept = Vec::new();
    assert!(calls_of(|| kept.push(1)) > 0, "one element: {kept:?}");
}

#[test]
fn plant_does_not_allocate() {
    for finger in [FingerParams::homogeneous(), FingerParams::layered()] {
        let layers = finger.layers.len();
        let mut plant = plant(finger);
        let skin_c = plant.skin_c();
        let legs = BridgeOutputs { a: Leg::Duty(0.7), b: Leg::Duty(0.3), enabled: true };
        let calls = calls_of(|| {
            for ms in 0..RUN_MS {
                plant.set_force(force_n(ms));
                plant.step(&legs);
                for channel in Channel::ALL {
                    plant.convert(channel);
                }
            }
        });
        assert_eq!(calls, 0, "{layers} layers");
        // It has been stepped, and has felt it.
        assert!((plant.skin_c() - skin_c).abs() > 0.1, "{layers} layers");
    }
}

#[test]
fn native_engine_does_not_allocate_without_a_stream() {
    let text = "duration_s = 2.0\nskin_c = 34.0\nroom_c = 24.0\nseed = 1\n[object]\nmaterial = \"granite\"\n";
    let scene = Scene::parse(text, Path::new("scene.toml")).expect("a sound scene");
    let mut native = NativeEngine::new(World::new(&scene).expect("a sound world"));
    let step = |native: &mut NativeEngine, force_n: f64| {
        native.world().set_force_and_faults(force_n, std::iter::empty());
        let legs = native.legs();
        native.world().step(legs);
        let Ok(()) = native.run_half_ms();
        let Ok(()) = native.run_half_ms();
        legs.enabled
    };
    for (ms, line) in (0..).zip(["material granite\n", "object room\n", "mode contact\n", "arm\n"])
    {
        native.send(line.as_bytes());
        for _ in 0..if ms < 3 { 3 } else { 2600 } {
            step(&mut native, 0.0);
        }
    }
    native.send(b"start\n");
    for _ in 0..3 {
        step(&mut native, 0.0);
    }
    let mut driven = 0;
    let calls = calls_of(|| {
        for ms in 0..RUN_MS {
            driven += u32::from(step(&mut native, force_n(ms)));
        }
    });
    assert_eq!(calls, 0);
    assert_eq!(driven, RUN_MS, "the bridge is driven throughout");
}
