//! The display plate's surface under current, finger and sink: a few relaxations that run beside the loop.
//!
//! A column of the tile (plate, tab, legs, hot plate on the sink) and what distinguishes the patch under the finger
//! from the rest of the plate are a network of heat capacities, and so a sum of relaxations. Those of the class module
//! (71 couples, 30 mm square, 0.8 mm of alumina) are in [`CLASS`], neighbours taken together; what is faster than a
//! tick follows at once.

use contact_model::fixed_point::{AHEAD_TICKS, Celsius};
use fixed::types::{I8F24, I20F12};

use crate::drive::Current;
use crate::settings::Module;
use crate::{
    TICK_HZ,
    control::lag::{Lag, Share},
};

/// Power in W, ±128.
pub type Watt = I8F24;

/// A relaxation: time constant, and where it comes to rest per watt pumped out of the plate, per watt of Joule's heat
/// in the legs, per watt of a finger on the patch (K/W), and per kelvin of the sink.
struct Relaxation {
    lag_s: f64,
    pump_k_w: f64,
    joule_k_w: f64,
    finger_k_w: f64,
    sink: f64,
}

const fn relaxation(lag_s: f64, pump_k_w: f64, joule_k_w: f64, finger_k_w: f64, sink: f64) -> Relaxation {
    Relaxation {
        lag_s,
        pump_k_w,
        joule_k_w,
        finger_k_w,
        sink,
    }
}

const RELAXATIONS: usize = 7;

/// All of the plate against the sink, the patch against the rest, the legs, the hot plate, and depth.
const CLASS: [Relaxation; RELAXATIONS] = [
    relaxation(10.241_19, 3.540_82, 1.813_82, 3.555_85, 1.039_67),
    relaxation(2.361_25, 0.0, 0.0, 3.203_31, 0.0),
    relaxation(0.186_38, 0.002_37, -0.029_61, 0.016_27, -0.069_41),
    relaxation(0.078_42, 0.000_14, -0.000_28, 0.002_14, 0.025_64),
    relaxation(0.010_79, -0.007_31, -0.000_99, 0.047_71, 0.004_10),
    relaxation(0.003_73, 0.001_38, -0.000_03, 0.002_40, 0.0),
    relaxation(0.001_66, -0.000_11, 0.0, 0.012_55, 0.0),
];
/// What a finger's heat does to the surface at once, K/W.
const FINGER_AT_ONCE_K_W: f64 = 0.011_25;
/// Joule's heat warms the legs above the mean of their ends, K/W, with this lag, s.
const LEGS_K_W: f64 = 0.292;
const LEGS_LAG_S: f64 = 0.186;
/// From the legs' hot end to the sink, K/W.
const HOT_K_W: f64 = 0.0285;
/// Bismuth telluride's Seebeck coefficient and resistivity rise with temperature, 1/K, from 27 °C on.
const SEEBECK_PER_K: f64 = 0.0016;
const RESISTIVITY_PER_K: f64 = 0.0049;
const SHEET: Celsius = Celsius::lit("27");
const ZERO_C_K: Celsius = Celsius::lit("273.15");

/// Ticks for which a current is held in mind when the next is chosen.
const HORIZON_TICKS: f64 = 12.0;

/// Binary places of what multiplies powers, and of the sink's part.
const GAIN_BITS: u32 = 28;

/// Fixed-point form of one [`Relaxation`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    lag: Lag,
    /// Part of the way to rest that is gone in [`HORIZON_TICKS`], 2^-31.
    ahead: i32,
    pump: i32,
    joule: i32,
    finger: i32,
    sink: i32,
}

/// What warms and cools the plate in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Heat {
    /// Pumped out of the plate.
    pub pumped: Watt,
    /// Joule's heat in the legs.
    pub joule: Watt,
    /// From the finger.
    pub finger: Watt,
    /// The sink.
    pub sink: Celsius,
}

/// The plate beside the loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    parts: [Part; RELAXATIONS],
    /// How much warmer the legs are than the mean of their ends.
    legs: Lag,
    hot: Celsius,
    surface: Celsius,
    /// V/K at 27 °C in 2^-31, ohm in 2^-24, and both per kelvin above, 2^-36 and 2^-31.
    seebeck: i32,
    ohm: i32,
    /// A per K that is missing at the horizon, at 300 K.
    per_k: I20F12,
}

fn scaled(value: f64, bits: u32) -> i32 {
    libm::round(libm::ldexp(value, bits as i32)) as i32
}

fn watt(bits: i64) -> Watt {
    Watt::from_bits(bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
}

impl Plate {
    /// `f64`, once.
    #[must_use]
    pub fn new(module: &Module) -> Self {
        let tick_s = 1.0 / f64::from(TICK_HZ);
        let gone = |lag_s: f64| 1.0 - libm::exp(-HORIZON_TICKS * tick_s / lag_s);
        let gain: f64 = CLASS.iter().map(|r| gone(r.lag_s) * r.pump_k_w).sum();
        Self {
            parts: CLASS.map(|r| Part {
                lag: Lag::new(Share::of(r.lag_s)),
                ahead: scaled(gone(r.lag_s), 31),
                pump: scaled(r.pump_k_w, GAIN_BITS),
                joule: scaled(r.joule_k_w, GAIN_BITS),
                finger: scaled(r.finger_k_w, GAIN_BITS),
                sink: scaled(r.sink, GAIN_BITS),
            }),
            legs: Lag::new(Share::of(LEGS_LAG_S)),
            hot: SHEET,
            surface: SHEET,
            seebeck: scaled(module.seebeck_v_k, 31),
            ohm: scaled(module.legs_ohm, 24),
            per_k: I20F12::saturating_from_num(1.0 / (gain * module.seebeck_v_k * 300.0)),
        }
    }

    /// Starts from a surface temperature, with everything else at rest without current.
    pub fn start(&mut self, surface: Celsius, sink: Celsius) {
        let at_rest = Heat {
            pumped: Watt::ZERO,
            joule: Watt::ZERO,
            finger: Watt::ZERO,
            sink,
        };
        let mut rest = surface;
        for i in (0..RELAXATIONS).rev() {
            let part = &mut self.parts[i];
            let at = if i == 0 { rest } else { part.rest(&at_rest) };
            part.lag.set(at);
            rest = rest.saturating_sub(at);
        }
        self.legs.set(Celsius::ZERO);
        (self.hot, self.surface) = (sink, surface);
    }

    /// The patch's surface.
    #[must_use]
    pub const fn surface(&self) -> Celsius {
        self.surface
    }

    /// The legs' hot ends.
    #[must_use]
    pub const fn hot(&self) -> Celsius {
        self.hot
    }

    /// The legs on average.
    #[must_use]
    pub fn legs(&self) -> Celsius {
        let ends = (self.surface >> 1u32).saturating_add(self.hot >> 1u32);
        ends.saturating_add(self.legs.value())
    }

    /// What a current does, with this finger and sink. Thomson's heat is in it: the pumping follows the legs' mean
    /// Seebeck coefficient.
    #[must_use]
    pub fn heat(&self, current: Current, finger: Watt, sink: Celsius) -> Heat {
        const FRACTION: i64 = 1 << 32;
        let warmer = i64::from(self.legs().saturating_sub(SHEET).to_bits());
        let grown = |value: i32, per_k: f64| {
            let per_k = (per_k * FRACTION as f64) as i64;
            (i64::from(value) * (FRACTION + ((warmer * per_k) >> 22))) >> 32
        };
        let kelvin = i64::from(self.surface.saturating_add(ZERO_C_K).to_bits());
        // V/K in 2^-31 times K in 2^-22.
        let volt = (grown(self.seebeck, SEEBECK_PER_K) * kelvin) >> (31 + 22 - 24);
        let amp = i64::from(current.to_bits());
        let square = (amp * amp) >> 24;
        Heat {
            pumped: watt((volt * amp) >> 24),
            joule: watt((grown(self.ohm, RESISTIVITY_PER_K) * square) >> 24),
            finger,
            sink,
        }
    }

    /// How much more current brings the surface to `target` at the horizon, if `heat` goes on until then.
    #[must_use]
    pub fn missing(&self, target: Celsius, heat: &Heat) -> Current {
        let mut there = i64::from(self.surface.to_bits());
        for part in &self.parts {
            let to_go = i64::from(part.rest(heat).saturating_sub(part.lag.value()).to_bits());
            there += (to_go * i64::from(part.ahead)) >> 31;
        }
        let above = there - i64::from(target.to_bits());
        let current = (above * i64::from(self.per_k.to_bits())) >> (22 + 12 - 24);
        Current::from_bits(current.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }

    /// One tick.
    pub fn step(&mut self, heat: &Heat) {
        let finger = i64::from(heat.finger.to_bits())
            * const { (FINGER_AT_ONCE_K_W * (1u64 << GAIN_BITS) as f64) as i64 };
        let mut surface = Celsius::from_bits((finger >> (GAIN_BITS + 2)) as i32);
        for part in &mut self.parts {
            let rest = part.rest(heat);
            part.lag.follow(rest);
            surface = surface.saturating_add(part.lag.value());
        }
        self.surface = surface;
        let per_watt = |watt: i64, k_w: f64| {
            let k_w = (k_w * (1u64 << GAIN_BITS) as f64) as i64;
            Celsius::from_bits(((watt * k_w) >> (GAIN_BITS + 2)) as i32)
        };
        let joule = i64::from(heat.joule.to_bits());
        self.legs.follow(per_watt(joule, LEGS_K_W));
        let out = joule + i64::from(heat.pumped.to_bits());
        self.hot = heat.sink.saturating_add(per_watt(out, HOT_K_W));
    }
}

impl Part {
    /// Where it comes to rest.
    fn rest(&self, heat: &Heat) -> Celsius {
        let times = |watt: Watt, gain: i32| i64::from(watt.to_bits()) * i64::from(gain);
        let powers =
            times(heat.joule, self.joule) + times(heat.finger, self.finger) - times(heat.pumped, self.pump);
        let sink = i64::from(heat.sink.to_bits()) * i64::from(self.sink);
        let rest = (powers >> (GAIN_BITS + 2)) + (sink >> GAIN_BITS);
        Celsius::from_bits(rest.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }
}

/// The horizon lies within what the skin's correction looks ahead.
const _: () = assert!(HORIZON_TICKS <= AHEAD_TICKS as f64);
