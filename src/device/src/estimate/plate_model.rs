//! Internal model of the display plate: its surface temperature under current, a finger's heat and the sink.
//!
//! A column of the tile (plate, solder tab, legs, hot plate on the sink), and the difference between the patch under the
//! finger and the rest of the plate, form a network of heat capacities, so the surface is a sum of first-order relaxations.
//! [`CLASS_RELAXATIONS`] has those of the class module (71 couples, 30 mm square, 0.8 mm of alumina), with neighbouring time
//! constants merged. What is faster than a tick acts at once.

use core::ops::Add;

use contact_model::fixed_point::{
    Celsius, MATCH_HORIZON_TICKS, product, saturated, saturating_product,
};
use fixed::types::extra::{LeEqU32, LeEqU64, U24};
use fixed::types::{I0F32, I1F31, I2F30, I4F28, I6F26, I8F24, I12F20, I12F52, I20F12};
use fixed::{FixedI32, FixedI64};
use thermal_settings::{Module, Tile};

use crate::TICK_HZ;
use crate::bismuth_telluride::{
    DATA_SHEET_TEMPERATURE, RESISTIVITY_RISE_PER_K, SEEBECK_RISE_PER_K,
};
use crate::drive::Current;
use crate::low_pass::{Coefficient, LowPass};

/// A power or heat flow, W: ±128 W at a resolution of 60 nW.
pub type Watt = I8F24;

/// A temperature in °C or a temperature difference in K within the plate model: ±2048 at a resolution of 1 µK.
type Kelvin = I12F20;

/// One first-order relaxation of the surface temperature: its time constant, s, and its steady-state contributions,
/// K/W, per watt pumped out of the plate, per watt of Joule heat in the legs, and per watt from the finger, in this
/// order. The first counts as cooling.
#[derive(Clone, Copy)]
struct Relaxation {
    time_constant_s: f64,
    gains_k_w: [f64; 3],
}

/// Builds one row of [`CLASS_RELAXATIONS`]: the time constant, s, then the three gains, K/W.
const fn relaxation(time_constant_s: f64, pumped: f64, joule: f64, finger: f64) -> Relaxation {
    Relaxation {
        time_constant_s,
        gains_k_w: [pumped, joule, finger],
    }
}

/// Number of relaxations whose sum is the surface temperature.
const RELAXATION_COUNT: usize = 5;

/// Relaxations of the class module, slowest first: the plate against the sink, the patch under the finger against the
/// rest of the plate, the legs, the hot plate, and the depth of the ceramic. Without heat the first decays to the
/// sink's temperature, the others to zero.
const CLASS_RELAXATIONS: [Relaxation; RELAXATION_COUNT] = [
    relaxation(10.241_19, 3.540_82, 1.813_82, 3.555_85),
    relaxation(2.361_25, 0.0, 0.0, 3.203_31),
    relaxation(0.186_38, 0.002_51, -0.029_89, 0.018_41),
    relaxation(0.010_79, -0.007_31, -0.000_99, 0.047_71),
    relaxation(0.003_73, 0.001_38, -0.000_03, 0.002_40),
];
/// Rise of the surface temperature, K, that each watt from the finger causes within the same tick.
const FINGER_FEEDTHROUGH_K_W: f64 = 0.023_80;
/// Rise of the legs' mean temperature above the mean of their two ends, K per watt of Joule heat, in the steady state.
const LEG_MEAN_RISE_K_W: I4F28 = I4F28::lit("0.292");
/// Time constant, s, with which the legs' mean temperature approaches that rise.
const LEG_TIME_CONSTANT_S: f64 = 0.186;
/// Thermal resistance, K/W, from the legs' hot ends through the hot plate to the sink.
const HOT_SIDE_RESISTANCE_K_W: I4F28 = I4F28::lit("0.0285");
const ZERO_C_IN_K: Celsius = Celsius::lit("273.15");

/// A tile's gain (K/s/A) differs from that of its class by the module's pumping and by the plate's heat capacity; only
/// the capacity changes the response to a finger's heat. The capacity is taken to cause this part of the gain's
/// logarithm.
const HEAT_CAPACITY_EXPONENT: f64 = 0.4;
/// Limit of the ratio of a tile's parameter to that of its class: from one half to this. Keeps the fixed-point gains
/// within the range of their types, whatever the identification has found.
const LARGEST_TILE_TO_CLASS_RATIO: f64 = 2.0;
/// Limit of the pumped heat and of the Joule heat in the model, W, in either direction, so that no state overflows.
const LARGEST_LEG_HEAT: Watt = Watt::lit("64");
/// Limit of the finger's heat in the model, W, in either direction, so that no state overflows.
const LARGEST_FINGER_HEAT: Watt = Watt::lit("8");
/// Limit of the sink's temperature in the model, °C, also below zero, so that no state overflows.
const LARGEST_SINK_TEMPERATURE: Celsius = Celsius::lit("100");
/// Limit of the difference between the legs' mean temperature and the data sheet's 27 °C, K, in either direction, by
/// which their resistance and Seebeck coefficient are corrected; keeps the products in range.
const LARGEST_LEG_DEVIATION: Celsius = Celsius::lit("100");

/// Horizon of the law `model`, ticks of 1 ms: each current is chosen as if it stayed for this time, so that the surface
/// reaches its target at the end.
const CONTROL_HORIZON_TICKS: f64 = 12.0;
/// The skin's correction is computed for [`MATCH_HORIZON_TICKS`], by the end of which the display must have reached its
/// target.
const _: () = assert!(CONTROL_HORIZON_TICKS <= MATCH_HORIZON_TICKS as f64);

/// Temperature change, K/W, that each of the model's three heat inputs causes, per watt; how long it acts depends on
/// the use (one tick, the horizon, or for ever).
#[derive(Clone, Copy, Debug, PartialEq)]
struct InputGains<Gain> {
    pumped: Gain,
    joule: Gain,
    finger: Gain,
}

impl<Frac: LeEqU32> InputGains<FixedI32<Frac>> {
    fn new([pumped, joule, finger]: [f64; 3]) -> Self {
        Self {
            pumped: rounded_fixed_point(pumped),
            joule: rounded_fixed_point(joule),
            finger: rounded_fixed_point(finger),
        }
    }

    /// Temperature change, K, by the three heat inputs together; pumped heat leaves the plate, so it counts negative.
    fn temperature_change(&self, inputs: &PlateInputs) -> FixedI64<<U24 as Add<Frac>>::Output>
    where
        U24: Add<Frac, Output: LeEqU64>,
    {
        inputs.joule.wide_mul(self.joule) - inputs.pumped.wide_mul(self.pumped)
            + inputs.finger.wide_mul(self.finger)
    }
}

/// Factors by which the identified tile differs from its class: of the gains for pumped heat, Joule heat and finger's
/// heat, and of the rate of the leak to the sink.
struct TileToClassRatios {
    pumped: f64,
    joule: f64,
    finger: f64,
    leak: f64,
}

impl TileToClassRatios {
    /// Ratios of an identified tile; each parameter's ratio is limited to 1/2 to 2.
    fn of(tile: &Tile) -> Self {
        let ratio = |identified: f64, class: f64| {
            (identified / class).clamp(
                1.0 / LARGEST_TILE_TO_CLASS_RATIO,
                LARGEST_TILE_TO_CLASS_RATIO,
            )
        };
        let gain = ratio(tile.gain_k_s_a, Tile::CLASS.gain_k_s_a);
        Self {
            pumped: gain,
            joule: ratio(gain * tile.joule_per_a, Tile::CLASS.joule_per_a),
            finger: libm::pow(gain, HEAT_CAPACITY_EXPONENT),
            leak: ratio(tile.leak_1_s, Tile::CLASS.leak_1_s),
        }
    }

    /// The tile's relaxation for one of the class. `slowest` marks the leak to the sink: a faster leak divides its time
    /// constant and its gains alike, so that the initial slopes stay.
    fn scale_relaxation(&self, slowest: bool, class: Relaxation) -> Relaxation {
        let leak = if slowest { self.leak } else { 1.0 };
        let [pumped, joule, finger] = class.gains_k_w;
        Relaxation {
            time_constant_s: class.time_constant_s / leak,
            gains_k_w: [
                pumped * self.pumped / leak,
                joule * self.joule / leak,
                finger * self.finger / leak,
            ],
        }
    }
}

/// One [`Relaxation`] of the tile in fixed point, with its present state.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RelaxationState {
    /// Present contribution of this relaxation to the surface temperature, K; for the slowest one °C, because it
    /// includes the sink.
    state: I12F52,
    /// Temperature change per watt of each input within one tick, K/W.
    tick_gains: InputGains<I4F28>,
    /// Temperature per watt of each input in the steady state, K/W; used to start the model.
    steady_state_gains: InputGains<I4F28>,
    /// Part of the state that decays in one tick of 1 ms; for the slowest relaxation also the part of the sink's
    /// temperature that is added.
    tick_decay: I0F32,
    /// Part of the state that decays within [`CONTROL_HORIZON_TICKS`].
    horizon_decay: I2F30,
}

impl RelaxationState {
    /// The state at the resolution of [`Kelvin`], rounded down.
    fn state_kelvin(&self) -> Kelvin {
        Kelvin::from_bits((self.state.to_bits() >> STATE_TO_KELVIN_SHIFT) as i32)
    }

    fn set_state_kelvin(&mut self, temperature: Kelvin) {
        self.state = kelvin_to_state(temperature);
    }
}

const STATE_TO_KELVIN_SHIFT: u32 = I12F52::FRAC_NBITS - Kelvin::FRAC_NBITS;

fn kelvin_to_state(temperature: Kelvin) -> I12F52 {
    I12F52::from_bits(i64::from(temperature.to_bits()) << STATE_TO_KELVIN_SHIFT)
}

/// Heat flows that act on the plate in one tick, and the temperature of the sink; each within the limit that keeps the
/// model from overflowing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlateInputs {
    /// Heat that the Peltier effect pumps out of the plate, W; negative while it heats.
    pub pumped: Watt,
    /// Joule heat in the module's legs, W; warms the plate in either direction of the current.
    pub joule: Watt,
    /// Heat flow from the finger into the plate, W; negative if the display is warmer than the skin.
    pub finger: Watt,
    /// Temperature of the sink, °C.
    pub sink: Celsius,
}

/// Resistance or Seebeck coefficient of the legs as a linear function of their mean temperature: value at the data
/// sheet's 27 °C, and rise per K.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LegProperty<Value> {
    value: Value,
    rise_per_k: Value,
}

impl<Frac: LeEqU32> LegProperty<FixedI32<Frac>> {
    fn new(value: f64, rise_per_k: f64) -> Self {
        Self {
            value: rounded_fixed_point(value),
            rise_per_k: rounded_fixed_point(rise_per_k * value),
        }
    }

    /// The property's value for legs whose mean temperature is `above_data_sheet`, K, above 27 °C.
    fn at(&self, above_data_sheet: Celsius) -> FixedI32<Frac> {
        self.value
            .saturating_add(product(above_data_sheet, self.rise_per_k))
    }
}

/// Temperatures of the module's semiconductor legs, from which their resistance and Seebeck voltage follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LegTemperatures {
    /// Temperature of the leg ends at the display, °C; the model takes that of the display's surface.
    pub cold: Celsius,
    /// Temperature of the leg ends at the sink, °C: the sink's, plus the rise by the heat that flows through the hot
    /// side.
    pub hot: Celsius,
    /// Mean temperature over the length of the legs, °C.
    pub mean: Celsius,
}

impl LegTemperatures {
    /// Temperatures of legs that carry little current: ends at the temperatures of display and sink, °C, and the mean
    /// half way between.
    #[must_use]
    pub fn between_display_and_sink(display: Celsius, sink: Celsius) -> Self {
        Self {
            cold: display,
            hot: sink,
            mean: (display >> 1u32).saturating_add(sink >> 1u32),
        }
    }
}

/// The internal model of plate and legs in fixed point: constants of one tile, and the temperatures of the present
/// tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateModel {
    relaxations: [RelaxationState; RELAXATION_COUNT],
    /// Change of the surface temperature at the end of [`CONTROL_HORIZON_TICKS`] per watt of each input, K/W, without
    /// the finger's feed-through.
    horizon_gains: InputGains<I6F26>,
    /// Rise of the surface within the tick, K per watt from the finger.
    finger_feedthrough: I4F28,
    /// Rise of the legs' mean temperature above the mean of their ends, K, behind the legs' time constant.
    leg_heating: LowPass,
    /// Temperature of the leg ends at the sink, °C.
    hot: Celsius,
    /// Temperature of the display's surface under the finger, °C.
    surface: Celsius,
    /// Seebeck coefficient of the whole module, V/K.
    seebeck: LegProperty<I1F31>,
    /// Electrical resistance of the legs without leads, ohm.
    resistance: LegProperty<I8F24>,
    /// Current, A, that changes the surface temperature by 1 K at the horizon, with legs at 27 °C and a surface at 300
    /// K.
    current_per_kelvin: I20F12,
}

/// The nearest fixed-point number. Computed in `f64`, so it is for start-up and not for the tick.
fn rounded_fixed_point<Frac: LeEqU32>(value: f64) -> FixedI32<Frac> {
    let places = FixedI32::<Frac>::FRAC_NBITS;
    FixedI32::from_bits(libm::round(libm::ldexp(value, places as i32)) as i32)
}

impl PlateModel {
    /// The model of a module on an identified tile, at the data sheet's 27 °C. Computed in `f64`, so it is for start-up
    /// and the task that serves the host, not for the tick.
    #[must_use]
    pub fn new(module: &Module, tile: &Tile) -> Self {
        let tick_s = 1.0 / f64::from(TICK_HZ);
        let decay =
            |ticks: f64, time_constant_s: f64| 1.0 - libm::exp(-ticks * tick_s / time_constant_s);
        let ratios = TileToClassRatios::of(tile);
        let mut slowest = true;
        let relaxations = CLASS_RELAXATIONS
            .map(|class| ratios.scale_relaxation(core::mem::take(&mut slowest), class));
        let mut horizon_gains = [0.0; 3];
        for relaxation in &relaxations {
            let decay = decay(CONTROL_HORIZON_TICKS, relaxation.time_constant_s);
            for (sum, gain) in horizon_gains.iter_mut().zip(relaxation.gains_k_w) {
                *sum += decay * gain;
            }
        }
        let [pumped_k_w, ..] = horizon_gains;
        Self {
            relaxations: relaxations.map(|relaxation| {
                let Relaxation {
                    time_constant_s,
                    gains_k_w,
                } = relaxation;
                let tick_decay = decay(1.0, time_constant_s);
                RelaxationState {
                    state: I12F52::ZERO,
                    tick_gains: InputGains::new(gains_k_w.map(|gain| tick_decay * gain)),
                    steady_state_gains: InputGains::new(gains_k_w),
                    tick_decay: rounded_fixed_point(tick_decay),
                    horizon_decay: rounded_fixed_point(decay(
                        CONTROL_HORIZON_TICKS,
                        time_constant_s,
                    )),
                }
            }),
            horizon_gains: InputGains::new(horizon_gains),
            finger_feedthrough: rounded_fixed_point(ratios.finger * FINGER_FEEDTHROUGH_K_W),
            leg_heating: LowPass::new(Coefficient::from_time_constant_s(LEG_TIME_CONSTANT_S)),
            hot: DATA_SHEET_TEMPERATURE,
            surface: DATA_SHEET_TEMPERATURE,
            seebeck: LegProperty::new(module.seebeck_v_k, SEEBECK_RISE_PER_K),
            resistance: LegProperty::new(module.legs_ohm, RESISTIVITY_RISE_PER_K),
            current_per_kelvin: rounded_fixed_point(
                1.0 / (pumped_k_w * module.seebeck_v_k * 300.0),
            ),
        }
    }

    /// Sets all temperatures to the steady state that has this `surface` temperature, °C, with `current`, A, the heat
    /// flow from the finger, W, and the sink's temperature, °C, constant. What those do not explain of the surface
    /// temperature is put into the slowest relaxation. Returns these inputs for the first tick.
    pub fn initialise_steady_state(
        &mut self,
        surface: Celsius,
        current: Current,
        finger: Watt,
        sink: Celsius,
    ) -> PlateInputs {
        self.leg_heating.set_output(Celsius::ZERO);
        (self.hot, self.surface) = (sink, surface);
        let inputs = self.inputs_of_tick(current, finger, sink);
        let mut remainder = to_model_resolution(surface)
            .saturating_sub(product(inputs.finger, self.finger_feedthrough));
        let [slowest, others @ ..] = &mut self.relaxations;
        for relaxation in others {
            relaxation.state = relaxation.steady_state_gains.temperature_change(&inputs);
            remainder -= relaxation.state_kelvin();
        }
        slowest.set_state_kelvin(remainder);
        inputs
    }

    /// Takes the constants of another tile's model; the present temperatures stay.
    pub fn set_parameters(&mut self, other: &Self) {
        let previous = *self;
        *self = *other;
        for (relaxation, previous) in self.relaxations.iter_mut().zip(&previous.relaxations) {
            relaxation.state = previous.state;
        }
        self.leg_heating = previous.leg_heating;
        (self.hot, self.surface) = (previous.hot, previous.surface);
    }

    /// Raises the plate's temperature by `by`, K, without any heat, because a new calibration reads the same plate that
    /// much higher. The legs' hot ends keep theirs.
    pub fn offset_temperatures(&mut self, by: Celsius) {
        let [slowest, ..] = &mut self.relaxations;
        slowest.state += kelvin_to_state(to_model_resolution(by));
        self.surface = self.surface.saturating_add(by);
    }

    /// Temperature of the display's surface in the patch under the finger, °C, at the end of the last tick.
    #[must_use]
    pub const fn surface(&self) -> Celsius {
        self.surface
    }

    /// Temperatures of the legs' ends and their mean, °C, at the end of the last tick.
    #[must_use]
    pub fn leg_temperatures(&self) -> LegTemperatures {
        let LegTemperatures { cold, hot, mean } =
            LegTemperatures::between_display_and_sink(self.surface, self.hot);
        LegTemperatures {
            cold,
            hot,
            mean: mean.saturating_add(self.leg_heating.output()),
        }
    }

    /// The model's inputs in a tick with this current, A (positive cools), heat flow from the finger, W, and sink
    /// temperature, °C. The pumped heat is computed with the Seebeck coefficient at the legs' mean temperature, which
    /// includes Thomson's heat.
    #[must_use]
    #[inline(always)]
    pub fn inputs_of_tick(&self, current: Current, finger: Watt, sink: Celsius) -> PlateInputs {
        let above_data_sheet = self
            .leg_temperatures()
            .mean
            .saturating_sub(DATA_SHEET_TEMPERATURE)
            .clamp(-LARGEST_LEG_DEVIATION, LARGEST_LEG_DEVIATION);
        let surface_k = self.surface.saturating_add(ZERO_C_IN_K);
        let peltier_v: I8F24 = product(self.seebeck.at(above_data_sheet), surface_k);
        let current_squared: I8F24 = saturating_product(current, current);
        let heat = |volts_or_ohms: I8F24, factor: I8F24| -> Watt {
            let heat: Watt = saturating_product(volts_or_ohms, factor);
            heat.clamp(-LARGEST_LEG_HEAT, LARGEST_LEG_HEAT)
        };
        PlateInputs {
            pumped: heat(peltier_v, current),
            joule: heat(self.resistance.at(above_data_sheet), current_squared),
            finger: finger.clamp(-LARGEST_FINGER_HEAT, LARGEST_FINGER_HEAT),
            sink: sink.clamp(-LARGEST_SINK_TEMPERATURE, LARGEST_SINK_TEMPERATURE),
        }
    }

    /// Current, A (positive cools), to be added to the one from which `inputs` were computed, so that the surface reaches
    /// `target`, °C, within the control horizon of 12 ms. Assumes that the finger's heat flow and the sink's temperature
    /// stay as in `inputs`, and neglects the change of the Joule heat.
    #[must_use]
    pub fn additional_current_to_target(&self, target: Celsius, inputs: &PlateInputs) -> Current {
        const ONE: I4F28 = I4F28::ONE;
        let [slowest, ..] = &self.relaxations;
        let mut change = self.horizon_gains.temperature_change(inputs)
            + to_model_resolution(inputs.sink).wide_mul(slowest.horizon_decay);
        for relaxation in &self.relaxations {
            change -= relaxation.state_kelvin().wide_mul(relaxation.horizon_decay);
        }
        change += self.surface.wide_mul(ONE) - target.wide_mul(ONE);
        let excess: Celsius = saturated(change);
        saturating_product(excess, self.current_per_kelvin)
    }

    /// Advances all temperatures by one tick of 1 ms under `inputs`.
    #[inline(never)]
    pub fn step(&mut self, inputs: &PlateInputs) {
        let mut surface: Kelvin = product(inputs.finger, self.finger_feedthrough);
        let [slowest, ..] = &mut self.relaxations;
        slowest.state += to_model_resolution(inputs.sink).wide_mul(slowest.tick_decay);
        for relaxation in &mut self.relaxations {
            relaxation.state += relaxation.tick_gains.temperature_change(inputs)
                - relaxation.state_kelvin().wide_mul(relaxation.tick_decay);
            surface += relaxation.state_kelvin();
        }
        self.surface = surface.saturating_to_num();
        self.leg_heating
            .filter(product(inputs.joule, LEG_MEAN_RISE_K_W));
        let heat_out = inputs.joule.saturating_add(inputs.pumped);
        let hot_side_rise = product(heat_out, HOT_SIDE_RESISTANCE_K_W);
        self.hot = inputs.sink.saturating_add(hot_side_rise);
    }
}

/// A temperature at the model's resolution of 1 µK, rounded down.
fn to_model_resolution(temperature: Celsius) -> Kelvin {
    Kelvin::from_bits(temperature.to_bits() >> (Celsius::FRAC_NBITS - Kelvin::FRAC_NBITS))
}
