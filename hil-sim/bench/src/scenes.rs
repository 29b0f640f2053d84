//! The model's share of a control tick, in each kind of scene: set-points (Eq. 6-12, 3-1) from ticks, force and the
//! temperatures before contact. Computed by the model in fixed point, by the same formulas in floating point, and by the
//! firmware's reference generator, which filters the force.

mod floating;

use contact_model::fixed_point::{
    Celsius, ChordInterpolation, ContactPair, ContactPairError, Force, log2_relative_pressure,
};
use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN, position};
use thermal_device::estimate::{Bodies, FingerEstimator};
use thermal_device::reference::{
    self, ContactModel, ReferenceGenerator, SETPOINT_INTERPOLATION_TOLERANCE,
};

use crate::kernels::{libm_f32, libm_f64, shepherd_laframboise};
use floating::Finger as FloatingFinger;

/// Length of a control tick.
pub const TICK_S: f64 = 1e-3;
/// Ticks of a scene: 10 s.
pub const TICKS: u32 = 10_000;
/// Skin temperature before contact.
pub const SKIN_C: f64 = 34.0;
/// Object temperature before contact.
pub const OBJECT_C: f64 = 24.0;
/// The constant force.
pub const FORCE_N: f64 = 2.0;
/// Materials of the five fingers, by their positions in [`MATERIALS`]. Scenes with one finger use the first.
pub const FINGERS: [usize; 5] = [
    position("granite").expect("a material"),
    position("copper").expect("a material"),
    position("stainless-steel").expect("a material"),
    position("abs").expect("a material"),
    position("foam").expect("a material"),
];

/// A kind of scene, in one arithmetic.
#[derive(Clone, Copy)]
pub struct Scene {
    /// Name of the kind.
    pub kind: &'static str,
    /// Arithmetic of the set-point.
    pub arithmetic: Arithmetic,
    /// Computes one tick, given the number of ticks since contact. Returns the bits of the first finger's set-point; in
    /// floating point returns 0 and leaves the set-point in the station.
    pub step: fn(&mut Station, u32) -> u32,
}

/// Arithmetic of a set-point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// The model's fixed point.
    Integers,
    /// The firmware's step from force to set-point.
    Firmware,
    /// Single precision, erfcx after Shepherd and Laframboise.
    Shepherd,
    /// Single precision, erfcx by libm.
    LibmF32,
    /// Double precision, erfcx by libm.
    LibmF64,
}

/// A finger in the model's fixed point.
#[derive(Clone)]
struct Finger {
    pair: ContactPair,
    chords: ChordInterpolation,
    /// Set-point of the last tick, if there are five fingers.
    set_point: Celsius,
}

/// State before the first tick.
#[derive(Clone)]
#[repr(C)] // The fingers come first, within the offset range of paired loads.
pub struct Station {
    fixed: [Finger; 5],
    skin: Celsius,
    object: Celsius,
    single: [FloatingFinger<f32>; 5],
    double: [FloatingFinger<f64>; 5],
    estimator: FingerEstimator,
    generator: ReferenceGenerator,
}

impl Station {
    /// Five fingers on the materials of [`FINGERS`], all under [`FORCE_N`].
    ///
    /// # Errors
    /// None for these materials.
    pub fn new() -> Result<Self, ContactPairError> {
        let force = Force::from_num(FORCE_N);
        let (skin, object_c) = (Celsius::from_num(SKIN_C), Celsius::from_num(OBJECT_C));
        let fixed = |finger: usize| {
            let object = &MATERIALS[FINGERS[finger]].1;
            let pair = ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, TICK_S)?;
            let contact = pair.at_pressure(log2_relative_pressure(force));
            let (chords, _) = ChordInterpolation::new(
                &contact,
                skin,
                object_c,
                0,
                SETPOINT_INTERPOLATION_TOLERANCE,
            );
            Ok(Finger { pair, chords, set_point: Celsius::ZERO })
        };
        let fixed = [fixed(0)?, fixed(1)?, fixed(2)?, fixed(3)?, fixed(4)?];
        let mut estimator = FingerEstimator::default();
        estimator.update_by_readings(skin, object_c, None, 0);
        Ok(Self {
            skin,
            object: object_c,
            estimator,
            generator: ReferenceGenerator::default(),
            fixed,
            single: FINGERS.map(|index| FloatingFinger::new(&MATERIALS[index].1)),
            double: FINGERS.map(|index| FloatingFinger::new(&MATERIALS[index].1)),
        })
    }
}

impl Station {
    /// Set-point of the first finger, °C, after a step that gave `bits`.
    pub fn set_point_c(&self, arithmetic: Arithmetic, bits: u32) -> f64 {
        match arithmetic {
            Arithmetic::Integers | Arithmetic::Firmware => Celsius::from_bits(bits as i32).to_num(),
            Arithmetic::Shepherd | Arithmetic::LibmF32 => f64::from(self.single[0].set_point_c),
            Arithmetic::LibmF64 => self.double[0].set_point_c,
        }
    }
}

/// Streaming force: a sawtooth from 1 to 2 N, in units of 2^-12 N above 1 N.
fn streaming(tick: u32) -> u32 {
    tick & 0xfff
}

/// Streaming force in fixed point.
fn streaming_fixed(tick: u32) -> Force {
    Force::from_bits((1 << 24) + (streaming(tick) << 12))
}

/// Streaming force, N.
pub fn streaming_n(tick: u32) -> f64 {
    1.0 + f64::from(streaming(tick)) / 4096.0
}

fn bits(set_point: Celsius) -> u32 {
    set_point.to_bits() as u32
}

fn idle(station: &mut Station, _: u32) -> u32 {
    bits(station.fixed[0].pair.preset(station.skin, station.object))
}

fn semi_infinite(station: &mut Station, _: u32) -> u32 {
    let [finger, ..] = &station.fixed;
    bits(finger.pair.interface_temperature(station.skin, station.object))
}

fn constant_force(station: &mut Station, _: u32) -> u32 {
    bits(station.fixed[0].chords.advance())
}

fn streaming_force(station: &mut Station, tick: u32) -> u32 {
    let contact = station.fixed[0].pair.at_pressure(log2_relative_pressure(streaming_fixed(tick)));
    bits(contact.at(tick, station.skin, station.object).display())
}

fn five_fingers(station: &mut Station, _: u32) -> u32 {
    for finger in &mut station.fixed {
        finger.set_point = finger.chords.advance();
    }
    bits(station.fixed[0].set_point)
}

/// The firmware's estimate and reference under a force; in the first tick a finger has landed one tick before. The skin
/// was observed, so there always is a reference.
#[inline]
fn reference_step(station: &mut Station, force: Force) -> u32 {
    station.estimator.update_by_readings(station.skin, station.object, Some(force), 1);
    let scene = reference::PresentedObject {
        pair: &station.fixed[0].pair,
        bodies: &Bodies::HALF_SPACES,
        object: Some(station.object),
        mode: ContactModel::ContactResistance,
    };
    let reference =
        station.generator.next_reference(&scene, &mut station.estimator, Celsius::ZERO, false);
    reference.map_or(0, |reference| bits(reference.setpoint.celsius()))
}

fn reference_constant(station: &mut Station, _: u32) -> u32 {
    reference_step(station, const { Force::lit("2") })
}

fn reference_streaming(station: &mut Station, tick: u32) -> u32 {
    reference_step(station, streaming_fixed(tick))
}

/// Only returns, which costs the overhead of a call.
#[inline(never)]
pub fn only_return_scene(_: &mut Station, _: u32) -> u32 {
    0
}

/// Kinds of scenes, as [`Scene::kind`] names them.
pub mod kind {
    /// No contact: the display is preset.
    pub const IDLE: &str = "idle";
    /// A finger under a constant force.
    pub const CONSTANT: &str = "constant force";
    /// A finger whose force changes in every tick, so that R and E are evaluated in every tick.
    pub const STREAMING: &str = "streaming force";
    /// Perfect contact (Eq. 3-1).
    pub const SEMI_INFINITE: &str = "semi-infinite";
    /// Five fingers under a constant force.
    pub const FIVE: &str = "five fingers";
    /// [`CONSTANT`] by the firmware, from landing on.
    pub const REFERENCE_CONSTANT: &str = "render step, constant force";
    /// [`STREAMING`] by the firmware, from landing on; R is evaluated when the mean of the force has changed.
    pub const REFERENCE_STREAMING: &str = "render step, streaming force";
}

const fn scene(
    kind: &'static str,
    arithmetic: Arithmetic,
    step: fn(&mut Station, u32) -> u32,
) -> Scene {
    Scene { kind, arithmetic, step }
}

use Arithmetic::{Firmware, Integers, LibmF32, LibmF64, Shepherd};

/// All kinds, each in the arithmetics that are compared.
pub static SCENES: [Scene; 18] = [
    scene(kind::IDLE, Integers, idle),
    scene(kind::IDLE, LibmF32, |s, _| {
        s.single[0].idle();
        0
    }),
    scene(kind::IDLE, LibmF64, |s, _| {
        s.double[0].idle();
        0
    }),
    scene(kind::CONSTANT, Integers, constant_force),
    scene(kind::CONSTANT, Shepherd, |s, n| {
        s.single[0].constant_force(n, shepherd_laframboise);
        0
    }),
    scene(kind::CONSTANT, LibmF32, |s, n| {
        s.single[0].constant_force(n, libm_f32);
        0
    }),
    scene(kind::CONSTANT, LibmF64, |s, n| {
        s.double[0].constant_force(n, libm_f64);
        0
    }),
    scene(kind::STREAMING, Integers, streaming_force),
    scene(kind::STREAMING, Shepherd, |s, n| {
        s.single[0].streaming_force(streaming(n), n, shepherd_laframboise);
        0
    }),
    scene(kind::STREAMING, LibmF32, |s, n| {
        s.single[0].streaming_force(streaming(n), n, libm_f32);
        0
    }),
    scene(kind::STREAMING, LibmF64, |s, n| {
        s.double[0].streaming_force(streaming(n), n, libm_f64);
        0
    }),
    scene(kind::SEMI_INFINITE, Integers, semi_infinite),
    scene(kind::SEMI_INFINITE, LibmF32, |s, _| {
        s.single[0].semi_infinite();
        0
    }),
    scene(kind::SEMI_INFINITE, LibmF64, |s, _| {
        s.double[0].semi_infinite();
        0
    }),
    scene(kind::FIVE, Integers, five_fingers),
    scene(kind::FIVE, Shepherd, |s, n| {
        for finger in &mut s.single {
            finger.constant_force(n, shepherd_laframboise);
        }
        0
    }),
    scene(kind::REFERENCE_CONSTANT, Firmware, reference_constant),
    scene(kind::REFERENCE_STREAMING, Firmware, reference_streaming),
];
