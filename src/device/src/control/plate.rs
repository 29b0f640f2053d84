//! The display plate's surface under current, finger and sink: a few relaxations that run beside the loop.
//!
//! A column of the tile (plate, tab, legs, hot plate on the sink) and what distinguishes the patch under the finger
//! from the rest of the plate are a network of heat capacities, and so a sum of relaxations. Those of the class module
//! (71 couples, 30 mm square, 0.8 mm of alumina) are in [`CLASS`], neighbours taken together; what is faster than a
//! tick follows at once.

use contact_model::fixed_point::{Celsius, MATCH_HORIZON_TICKS};
use fixed::types::I8F24;

use super::lag::{Lag, Share};
use crate::TICK_HZ;
use crate::drive::Current;
use thermal_settings::{Module, Tile};

/// Power in W, ±128.
pub type Watt = I8F24;

/// A relaxation: time constant, and where it comes to rest per watt pumped out of the plate, per watt of Joule's heat
/// in the legs, and per watt of a finger on the patch (K/W).
#[derive(Clone, Copy)]
struct Relaxation {
    lag_s: f64,
    weights: [f64; 3],
}

const fn relaxation(lag_s: f64, pumped: f64, joule: f64, finger: f64) -> Relaxation {
    Relaxation {
        lag_s,
        weights: [pumped, joule, finger],
    }
}

const RELAXATIONS: usize = 5;

/// All of the plate against the sink, the patch against the rest, the legs, the hot plate, and depth. The first comes to
/// rest where the sink is.
const CLASS: [Relaxation; RELAXATIONS] = [
    relaxation(10.241_19, 3.540_82, 1.813_82, 3.555_85),
    relaxation(2.361_25, 0.0, 0.0, 3.203_31),
    relaxation(0.186_38, 0.002_51, -0.029_89, 0.018_41),
    relaxation(0.010_79, -0.007_31, -0.000_99, 0.047_71),
    relaxation(0.003_73, 0.001_38, -0.000_03, 0.002_40),
];
/// What a finger's heat does to the surface at once, K/W.
const FINGER_AT_ONCE_K_W: f64 = 0.023_80;
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

/// A gain that differs comes from the module's pumping and from the plate's heat capacity; only the latter changes what
/// a finger does. Part of the gain's logarithm that is the capacity's.
const CAPACITY_SHARE: f64 = 0.4;
/// A tile differs from its class by no more.
const MOST_TIMES: f64 = 2.0;
/// Most that is pumped or warms the legs, that a finger gives, and that the sink is off zero: no state overflows.
const MOST_WATT: i64 = 64 << Watt::FRAC_NBITS;
const MOST_FINGER: Watt = Watt::lit("8");
const MOST_SINK: Celsius = Celsius::lit("100");
/// And the legs off 27 °C.
const WARMER: Celsius = Celsius::lit("100");

/// Ticks for which a current is held in mind when the next is chosen.
const HORIZON_TICKS: f64 = 12.0;

/// Binary places of a temperature here, and of its state, which no rounding holds back.
const KELVIN_BITS: u32 = 20;
const STATE_BITS: u32 = KELVIN_BITS + 32;
/// Of what multiplies powers to give a state's change.
const POWER_BITS: u32 = STATE_BITS - Watt::FRAC_NBITS;
/// Of a part of the way to rest.
const AHEAD_BITS: u32 = 30;
/// What a temperature times that has less than a state.
const AHEAD_FEWER: u32 = STATE_BITS - KELVIN_BITS - AHEAD_BITS;

/// What multiplies the powers: pumped, Joule's, the finger's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Weights {
    pumped: i32,
    joule: i32,
    finger: i32,
}

impl Weights {
    /// Of so much per watt and kelvin, in so many binary places less than a state's.
    fn new([pumped, joule, finger]: [f64; 3], fewer_bits: u32) -> Self {
        Self {
            pumped: scaled(pumped, POWER_BITS - fewer_bits),
            joule: scaled(joule, POWER_BITS - fewer_bits),
            finger: scaled(finger, POWER_BITS - fewer_bits),
        }
    }

    fn sum(&self, heat: &Heat) -> i64 {
        times(heat.joule.to_bits(), self.joule) - times(heat.pumped.to_bits(), self.pumped)
            + times(heat.finger.to_bits(), self.finger)
    }
}

fn times(a: i32, b: i32) -> i64 {
    i64::from(a) * i64::from(b)
}

/// How a tile differs from its class.
struct Scale {
    pumped: f64,
    joule: f64,
    finger: f64,
    leak: f64,
}

impl Scale {
    fn of(tile: &Tile) -> Self {
        let times = |found: f64, class: f64| (found / class).clamp(1.0 / MOST_TIMES, MOST_TIMES);
        let gain = times(tile.gain_k_s_a, Tile::CLASS.gain_k_s_a);
        Self {
            pumped: gain,
            joule: times(gain * tile.joule_per_a, Tile::CLASS.joule_per_a),
            finger: libm::pow(gain, CAPACITY_SHARE),
            leak: times(tile.leak_1_s, Tile::CLASS.leak_1_s),
        }
    }

    /// The slowest relaxation is the leak to the sink: its slopes stay as they are when its rate changes.
    fn apply(&self, slowest: bool, class: Relaxation) -> Relaxation {
        let leak = if slowest { self.leak } else { 1.0 };
        let [pumped, joule, finger] = class.weights;
        Relaxation {
            lag_s: class.lag_s / leak,
            weights: [
                pumped * self.pumped / leak,
                joule * self.joule / leak,
                finger * self.finger / leak,
            ],
        }
    }
}

/// Fixed-point form of one [`Relaxation`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    /// K, [`STATE_BITS`] binary places.
    state: i64,
    /// What the inputs add to it in a tick, and where they bring it in the end.
    given: Weights,
    rest: Weights,
    /// What it loses in a tick, 2^-32 of itself.
    lost: i32,
    /// Part of the way to rest that is gone in [`HORIZON_TICKS`].
    ahead: i32,
}

/// What warms and cools the plate in a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    parts: [Part; RELAXATIONS],
    /// Sum of the parts' weights, as far as each is on its way at the horizon.
    ahead: Weights,
    /// What a finger's heat does at once.
    finger_at_once: i32,
    /// How much warmer the legs are than the mean of their ends.
    legs: Lag,
    hot: Celsius,
    surface: Celsius,
    /// V/K at 27 °C and by how much that rises per K, 2^-31; ohm likewise, 2^-24.
    seebeck: [i32; 2],
    ohm: [i32; 2],
    /// A per K that is missing at the horizon, at 300 K, in 2^-12.
    per_k: i32,
}

fn scaled(value: f64, bits: u32) -> i32 {
    libm::round(libm::ldexp(value, bits as i32)) as i32
}

impl Plate {
    /// Of a module on a tile as tuning has found it; `f64`, once.
    #[must_use]
    pub fn new(module: &Module, tile: &Tile) -> Self {
        let tick_s = 1.0 / f64::from(TICK_HZ);
        let gone = |ticks: f64, lag_s: f64| 1.0 - libm::exp(-ticks * tick_s / lag_s);
        let as_found = Scale::of(tile);
        let mut slowest = true;
        let relaxations = CLASS.map(|class| as_found.apply(core::mem::take(&mut slowest), class));
        let gain: f64 = relaxations
            .iter()
            .map(|r| gone(HORIZON_TICKS, r.lag_s) * r.weights[0])
            .sum();
        let mut ahead = [0.0; 3];
        for r in &relaxations {
            for (sum, weight) in ahead.iter_mut().zip(r.weights) {
                *sum += gone(HORIZON_TICKS, r.lag_s) * weight;
            }
        }
        Self {
            parts: relaxations.map(|r| {
                let share = gone(1.0, r.lag_s);
                Part {
                    state: 0,
                    given: Weights::new(r.weights.map(|weight| share * weight), 0),
                    rest: Weights::new(r.weights, 0),
                    lost: scaled(share, 32),
                    ahead: scaled(gone(HORIZON_TICKS, r.lag_s), AHEAD_BITS),
                }
            }),
            ahead: Weights::new(ahead, AHEAD_FEWER),
            finger_at_once: scaled(as_found.finger * FINGER_AT_ONCE_K_W, 28),
            legs: Lag::new(Share::of(LEGS_LAG_S)),
            hot: SHEET,
            surface: SHEET,
            seebeck: [1.0, SEEBECK_PER_K].map(|part| scaled(part * module.seebeck_v_k, 31)),
            ohm: [1.0, RESISTIVITY_PER_K].map(|part| scaled(part * module.legs_ohm, 24)),
            per_k: scaled(1.0 / (gain * module.seebeck_v_k * 300.0), 12),
        }
    }

    /// Starts from a surface temperature, as if this current, finger and sink had been so for long; gives what they do.
    pub fn start(
        &mut self,
        surface: Celsius,
        current: Current,
        finger: Watt,
        sink: Celsius,
    ) -> Heat {
        self.legs.set(Celsius::ZERO);
        (self.hot, self.surface) = (sink, surface);
        let heat = self.heat(current, finger, sink);
        let mut rest = kelvin(surface).saturating_sub(self.at_once(&heat));
        let [slowest, others @ ..] = &mut self.parts;
        for part in others {
            part.state = part.rest.sum(&heat);
            rest -= part.kelvin();
        }
        slowest.state = i64::from(rest) << 32;
        heat
    }

    /// Goes on as another one, from where it is.
    pub fn become_like(&mut self, other: &Self) {
        let before = *self;
        *self = *other;
        for (part, before) in self.parts.iter_mut().zip(&before.parts) {
            part.state = before.state;
        }
        (self.legs, self.hot, self.surface) = (before.legs, before.hot, before.surface);
    }

    /// Moves all of it, as its temperature is told in another scale.
    pub fn shift(&mut self, by: Celsius) {
        let [slowest, ..] = &mut self.parts;
        slowest.state += i64::from(kelvin(by)) << 32;
        self.surface = self.surface.saturating_add(by);
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
        let warmer = self.legs().saturating_sub(SHEET).clamp(-WARMER, WARMER);
        let grown = |[value, per_k]: [i32; 2]| {
            value.saturating_add((times(warmer.to_bits(), per_k) >> Celsius::FRAC_NBITS) as i32)
        };
        // V/K in 2^-31 times K in 2^-22, and then A in 2^-24; 64 W at most, and no more than a tile can do.
        let kelvin = self.surface.saturating_add(ZERO_C_K).to_bits();
        let volt = (times(grown(self.seebeck), kelvin) >> (31 + 22 - 24)) as i32;
        let amp = current.to_bits();
        let square = (times(amp, amp) >> 24).min(i32::MAX.into()) as i32;
        let watt = |bits: i64| Watt::from_bits((bits >> 24).clamp(-MOST_WATT, MOST_WATT) as i32);
        Heat {
            pumped: watt(times(volt, amp)),
            joule: watt(times(grown(self.ohm), square)),
            finger: finger.clamp(-MOST_FINGER, MOST_FINGER),
            sink: sink.clamp(-MOST_SINK, MOST_SINK),
        }
    }

    /// How much more current brings the surface to `target` at the horizon, if `heat` goes on until then.
    #[must_use]
    pub fn missing(&self, target: Celsius, heat: &Heat) -> Current {
        let [slowest, ..] = &self.parts;
        let mut to_go = self.ahead.sum(heat) + times(kelvin(heat.sink), slowest.ahead);
        for part in &self.parts {
            to_go -= times(part.kelvin(), part.ahead);
        }
        let above = (to_go >> (STATE_BITS - AHEAD_FEWER - Celsius::FRAC_NBITS))
            + i64::from(self.surface.to_bits())
            - i64::from(target.to_bits());
        let above = above.clamp(i32::MIN.into(), i32::MAX.into()) as i32;
        let current = times(above, self.per_k) >> (22 + 12 - 24);
        Current::from_bits(current.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }

    /// What the finger's heat does at once, K in 2^-20.
    fn at_once(&self, heat: &Heat) -> i32 {
        (times(heat.finger.to_bits(), self.finger_at_once) >> 32) as i32
    }

    /// One tick.
    pub fn step(&mut self, heat: &Heat) {
        let mut surface = self.at_once(heat);
        let [slowest, ..] = &mut self.parts;
        slowest.state += times(kelvin(heat.sink), slowest.lost);
        for part in &mut self.parts {
            part.state += part.given.sum(heat) - times(part.kelvin(), part.lost);
            surface += part.kelvin();
        }
        let bits = i64::from(surface) << (Celsius::FRAC_NBITS - KELVIN_BITS);
        self.surface = Celsius::from_bits(bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32);
        let per_watt = |watt: i32, k_w: i32| Celsius::from_bits((times(watt, k_w) >> 30) as i32);
        let joule = heat.joule.to_bits();
        self.legs
            .follow(per_watt(joule, const { (LEGS_K_W * 268_435_456.0) as i32 }));
        let out = joule.saturating_add(heat.pumped.to_bits());
        self.hot = heat
            .sink
            .saturating_add(per_watt(out, const { (HOT_K_W * 268_435_456.0) as i32 }));
    }
}

impl Part {
    /// Where it is, K in 2^-20.
    const fn kelvin(&self) -> i32 {
        (self.state >> 32) as i32
    }
}

/// K in 2^-20.
const fn kelvin(at: Celsius) -> i32 {
    at.to_bits() >> (Celsius::FRAC_NBITS - KELVIN_BITS)
}

/// The horizon lies within what the skin's correction looks ahead.
const _: () = assert!(HORIZON_TICKS <= MATCH_HORIZON_TICKS as f64);
