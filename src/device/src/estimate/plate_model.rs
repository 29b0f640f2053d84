//! Internal model of the display plate: its surface temperature as a result of the current, the finger's heat and the
//! sink's temperature.
//!
//! The tile is modelled as a column of heat capacities (plate, solder tab, legs, hot plate on the sink). A further
//! state is the temperature difference between the patch under the finger and the rest of the plate. The surface
//! temperature of such a network is a sum of first-order relaxations. [`CLASS_RELAXATIONS`] lists those of the class
//! module (71 couples, 30 mm square, 0.8 mm of alumina), with neighbouring time constants merged. Responses that are
//! faster than a tick of 1 ms are modelled as immediate.

use core::ops::Add;

use contact_model::fixed_point::{
    Celsius, MATCH_HORIZON_TICKS, product, saturated, saturating_product, to_fixed,
};
use fixed::types::extra::{LeEqU32, LeEqU64, U24};
use fixed::types::{I0F32, I1F31, I2F30, I4F28, I6F26, I8F24, I12F20, I12F52, I20F12};
use fixed::{FixedI32, FixedI64};
use thermal_settings::{PeltierModule, Tile};

use crate::TICK_S;
use crate::bismuth_telluride::{
    DATA_SHEET_TEMPERATURE, RESISTIVITY_RISE_PER_K, SEEBECK_RISE_PER_K,
};
use crate::drive::Current;
use crate::low_pass::{Coefficient, LowPass};

/// A power or heat flow, W: ±128 W at a resolution of 60 nW.
pub type Watt = I8F24;

/// Temperature in °C or temperature difference in K within the plate model: ±2048 with a resolution of 1 µK.
type ModelTemperature = I12F20;

/// One first-order relaxation of the plate model: its time constant, s, and its steady-state gains, K/W, for the three heat
/// inputs in the order heat pumped out of the plate, Joule heat in the legs, heat from the finger. The surface temperature
/// is the sum of five relaxations and of the finger's immediate effect, [`FINGER_FEEDTHROUGH_K_W`]. The gain for pumped
/// heat is the fall of the temperature, positive if pumping cools;
/// [`HeatInputGains::added_to`] subtracts it.
#[derive(Clone, Copy)]
struct RelaxationParameters {
    time_constant_s: f64,
    gains_k_w: [f64; 3],
}

/// Builds one row of [`CLASS_RELAXATIONS`]: time constant, s, then the contributions to the surface temperature in the
/// steady state, K/W, per watt of pumped heat, of Joule heat and of heat from the finger.
const fn class_relaxation_row(
    time_constant_s: f64,
    pumped: f64,
    joule: f64,
    finger: f64,
) -> RelaxationParameters {
    RelaxationParameters { time_constant_s, gains_k_w: [pumped, joule, finger] }
}

/// Number of relaxations in the plate model; the surface temperature is their sum and the finger's immediate effect.
const RELAXATION_COUNT: usize = 5;

/// Relaxations of the class module (the nominal module), slowest first: the plate relative to the sink, the patch under
/// the finger relative to the rest of the plate, the legs, the hot plate, and the temperature difference across the
/// thickness of the ceramic. Without heat flow the first decays to the sink's temperature, the others to zero.
const CLASS_RELAXATIONS: [RelaxationParameters; RELAXATION_COUNT] = [
    class_relaxation_row(10.241_19, 3.540_82, 1.813_82, 3.555_85),
    class_relaxation_row(2.361_25, 0.0, 0.0, 3.203_31),
    class_relaxation_row(0.186_38, 0.002_51, -0.029_89, 0.018_41),
    class_relaxation_row(0.010_79, -0.007_31, -0.000_99, 0.047_71),
    class_relaxation_row(0.003_73, 0.001_38, -0.000_03, 0.002_40),
];
/// Immediate rise of the class module's surface temperature, K, per watt of heat from the finger: the sum of all
/// responses that are faster than a tick of 1 ms.
const FINGER_FEEDTHROUGH_K_W: f64 = 0.023_80;
/// Rise of the legs' mean temperature above the mean of their two ends, K per watt of Joule heat, in the steady state.
const LEG_MEAN_RISE_PER_JOULE_HEAT_K_W: I4F28 = I4F28::lit("0.292");
/// Time constant, s, with which the legs' mean temperature follows the temperatures of their ends and the Joule heat
/// ([`LEG_MEAN_RISE_PER_JOULE_HEAT_K_W`]).
const LEG_MEAN_TIME_CONSTANT_S: f64 = 0.186;
/// Thermal resistance, K/W, from the hot ends of the legs through the hot plate to the sink.
const HOT_SIDE_THERMAL_RESISTANCE_K_W: I4F28 = I4F28::lit("0.0285");
const ZERO_C_IN_K: Celsius = Celsius::lit("273.15");

/// Exponent, 0.4, in the response of a tile to the finger's heat: relative to the class tile, this response is the
/// tile's gain (cooling rate per ampere, K/s/A) to the power of 0.4. The gain may differ from that of the class tile by
/// the heat that the module pumps per ampere, or by the heat capacity of the plate. Only the heat capacity changes the
/// response to the finger's heat; it is assumed to cause 0.4 of the difference, on a logarithmic scale.
const GAIN_RATIO_TO_FINGER_RATIO_EXPONENT: f64 = 0.4;
/// Largest ratio of an identified parameter of a tile (gain, Joule heat, leak) to that of the class tile; the smallest
/// is its reciprocal, 1/2. The limits keep the fixed-point gains in range, whatever values the identification has
/// found.
const TILE_TO_CLASS_RATIO_OR_INVERSE_CLAMP: f64 = 2.0;
/// Limit, W, of the pumped heat and of the Joule heat in the model, in either direction; keeps the model's fixed-point
/// states from overflowing.
const PUMPED_OR_JOULE_HEAT_MAX_MAGNITUDE: Watt = Watt::lit("64");
/// Limit of the finger's heat flow in the model, W, in either direction; keeps the model's fixed-point states from
/// overflowing.
const FINGER_HEAT_MAX_MAGNITUDE: Watt = Watt::lit("8");
/// Limit of the sink's temperature in the model, -100 to 100 °C; keeps the model's fixed-point states from overflowing.
const SINK_TEMPERATURE_MAX_MAGNITUDE: Celsius = Celsius::lit("100");
/// Limit, K, of the difference between the legs' mean temperature and the data sheet's 27 °C, in either direction. The
/// legs' resistance and Seebeck coefficient are corrected for this difference; the limit keeps the products in range.
const LEG_DEVIATION_FROM_27_C_MAX_MAGNITUDE: Celsius = Celsius::lit("100");

/// Horizon of the law `model`, ticks of 1 ms: the law chooses the current which, if held constant, brings the surface
/// to its target after this time. 12 ms are about the delay with which the display's surface responds to a current.
const CONTROL_HORIZON_TICKS: f64 = 12.0;
// The correction of the skin is computed for `MATCH_HORIZON_TICKS`, by the end of which the display must have reached
// its target.
const _: () = assert!(CONTROL_HORIZON_TICKS <= MATCH_HORIZON_TICKS as f64);

/// Change, K/W, of the display's surface temperature, or of one relaxation's contribution to it, per watt of each heat
/// input: heat pumped out of the plate by the Peltier effect, Joule heat in the legs, heat from the finger. Each value
/// of this type is for heat that acts constantly for one time: one tick of 1 ms, the control horizon of 12 ms, or until
/// the steady state. [`Self::added_to`] subtracts the pumped heat, because it leaves the plate.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HeatInputGains<Gain> {
    pumped: Gain,
    joule: Gain,
    finger: Gain,
}

impl<Frac: LeEqU32> HeatInputGains<FixedI32<Frac>> {
    const ZERO: Self =
        Self { pumped: FixedI32::ZERO, joule: FixedI32::ZERO, finger: FixedI32::ZERO };

    fn new([pumped, joule, finger]: [f64; 3]) -> Self {
        Self { pumped: to_fixed(pumped), joule: to_fixed(joule), finger: to_fixed(finger) }
    }

    /// `temperature`, K or °C, plus the change of the display's surface temperature, or of one relaxation's contribution
    /// to it, by the three heat inputs of the plate together: pumped heat, Joule heat, and heat from the finger. Pumped
    /// heat leaves the plate, so its negative is added. Each product is added to the sum so far, for which the processor
    /// has one instruction; it needs three to add a sum of products or to subtract a product.
    fn added_to(
        &self,
        temperature: FixedI64<<U24 as Add<Frac>>::Output>,
        inputs: &PlateInputs,
    ) -> FixedI64<<U24 as Add<Frac>>::Output>
    where
        U24: Add<Frac, Output: LeEqU64>,
    {
        temperature
            + (-inputs.pumped).wide_mul(self.pumped)
            + inputs.joule.wide_mul(self.joule)
            + inputs.finger.wide_mul(self.finger)
    }
}

/// Ratios of an identified tile's parameters to those of the class (nominal) tile: for the gains of pumped heat, Joule
/// heat and heat from the finger, and for the rate of the heat leak to the sink.
struct TileToClassRatios {
    pumped: f64,
    joule: f64,
    finger: f64,
    leak: f64,
}

impl TileToClassRatios {
    /// Ratios of the parameters of an identified tile to those of the class (nominal) tile, each limited to the range
    /// of 1/2 to 2.
    fn of(tile: &Tile) -> Self {
        let ratio = |identified: f64, class: f64| {
            (identified / class).clamp(
                1.0 / TILE_TO_CLASS_RATIO_OR_INVERSE_CLAMP,
                TILE_TO_CLASS_RATIO_OR_INVERSE_CLAMP,
            )
        };
        let gain = ratio(tile.gain_k_s_a, Tile::FACTORY_DEFAULT.gain_k_s_a);
        Self {
            pumped: gain,
            joule: ratio(gain * tile.joule_per_a, Tile::FACTORY_DEFAULT.joule_per_a),
            finger: libm::exp(GAIN_RATIO_TO_FINGER_RATIO_EXPONENT * libm::log(gain)),
            leak: ratio(tile.leak_1_s, Tile::FACTORY_DEFAULT.leak_1_s),
        }
    }

    /// Scales a relaxation of the class tile to the identified tile: multiplies its steady-state gains by the ratios
    /// for pumped heat, Joule heat and the finger's heat. The first relaxation is that towards the sink; its time
    /// constant and its gains are also divided by the ratio of the leak. The initial rate of change per watt then does
    /// not depend on the leak.
    #[inline(never)]
    fn scale_relaxation(&self, index: usize) -> RelaxationParameters {
        let class = &CLASS_RELAXATIONS[index.min(RELAXATION_COUNT - 1)];
        let leak = if index == 0 { self.leak } else { 1.0 };
        let [pumped, joule, finger] = class.gains_k_w;
        RelaxationParameters {
            time_constant_s: class.time_constant_s / leak,
            gains_k_w: [
                pumped * self.pumped / leak,
                joule * self.joule / leak,
                finger * self.finger / leak,
            ],
        }
    }
}

/// One first-order relaxation of the tile's surface temperature in fixed point: constants and present state.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FixedPointRelaxation {
    /// Present contribution of this relaxation to the surface temperature, K; for the slowest relaxation a temperature
    /// in °C, because it contains the sink's temperature.
    state: I12F52,
    /// Change of this relaxation's state within one tick of 1 ms, K/W, per watt of pumped heat (whose effect is
    /// subtracted), of Joule heat, and of heat from the finger.
    tick_gains: HeatInputGains<I4F28>,
    /// Contribution of this relaxation to the surface temperature in the steady state, K/W, per watt of pumped heat
    /// (whose effect is subtracted), of Joule heat, and of heat from the finger. Used only to start the model.
    steady_state_gains: HeatInputGains<I4F28>,
    /// Change of the state in one tick of 1 ms over the state, `e^(-1 ms / time constant) - 1`: negative, so that its
    /// product is added. In the slowest relaxation the same fraction of the sink's temperature is subtracted.
    tick_change: I0F32,
    /// The same for [`CONTROL_HORIZON_TICKS`] (12 ms).
    horizon_change: I2F30,
}

impl FixedPointRelaxation {
    const ZERO: Self = Self {
        state: I12F52::ZERO,
        tick_gains: HeatInputGains::ZERO,
        steady_state_gains: HeatInputGains::ZERO,
        tick_change: I0F32::ZERO,
        horizon_change: I2F30::ZERO,
    };

    #[inline(never)]
    fn new(relaxation: &RelaxationParameters) -> Self {
        let RelaxationParameters { time_constant_s, gains_k_w } = *relaxation;
        let tick_decay = decay(1.0, time_constant_s);
        Self {
            state: I12F52::ZERO,
            tick_gains: HeatInputGains::new(gains_k_w.map(|gain| tick_decay * gain)),
            steady_state_gains: HeatInputGains::new(gains_k_w),
            tick_change: to_fixed(-tick_decay),
            horizon_change: to_fixed(-decay(CONTROL_HORIZON_TICKS, time_constant_s)),
        }
    }

    /// State of the relaxation, K or °C, rounded down to the resolution of [`ModelTemperature`] (1 µK).
    fn state_temperature(&self) -> ModelTemperature {
        ModelTemperature::from_bits(
            (self.state.to_bits() >> STATE_TO_MODEL_TEMPERATURE_SHIFT) as i32,
        )
    }

    fn set_state_temperature(&mut self, temperature: ModelTemperature) {
        self.state = temperature_to_state(temperature);
    }
}

const STATE_TO_MODEL_TEMPERATURE_SHIFT: u32 = I12F52::FRAC_NBITS - ModelTemperature::FRAC_NBITS;

fn temperature_to_state(temperature: ModelTemperature) -> I12F52 {
    I12F52::from_bits(i64::from(temperature.to_bits()) << STATE_TO_MODEL_TEMPERATURE_SHIFT)
}

/// Heat flows that act on the plate in one tick, W, and the temperature of the heat sink, °C.
/// [`PlateModel::inputs_of_tick`] limits each of them, to keep the model from overflowing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlateInputs {
    /// Heat that the Peltier effect pumps out of the plate, W; negative while it heats.
    pub pumped: Watt,
    /// Joule heat in the module's legs, W; it warms the plate for either direction of the current, so it is never
    /// negative.
    pub joule: Watt,
    /// Heat flow from the finger into the plate, W; negative if the display is warmer than the skin's surface.
    pub finger: Watt,
    /// Temperature of the module's heat sink, °C.
    pub sink: Celsius,
}

/// Resistance or Seebeck coefficient of the legs as a linear function of their mean temperature: value at the data
/// sheet's 27 °C, and rise per kelvin.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LinearInLegTemperature<Value> {
    value: Value,
    rise_per_k: Value,
}

impl<Frac: LeEqU32> LinearInLegTemperature<FixedI32<Frac>> {
    fn new(value: f64, rise_per_k: f64) -> Self {
        Self { value: to_fixed(value), rise_per_k: to_fixed(rise_per_k * value) }
    }

    /// Resistance or Seebeck coefficient of legs whose mean temperature is 27 °C plus `above_data_sheet`, K.
    fn at(&self, above_data_sheet: Celsius) -> FixedI32<Frac> {
        self.value.saturating_add(product(above_data_sheet, self.rise_per_k))
    }
}

/// Temperatures, °C, of the module's semiconductor legs; the resistance and the Seebeck voltage of the module are
/// computed from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LegTemperatures {
    /// Temperature of the leg ends at the display, °C; the model takes it to be that of the display's surface.
    pub cold: Celsius,
    /// Temperature of the leg ends at the sink, °C: the sink's temperature plus the rise by the heat that flows from
    /// the legs through the hot plate.
    pub hot: Celsius,
    /// Mean temperature over the length of the legs, °C.
    pub mean: Celsius,
}

impl LegTemperatures {
    /// Temperatures of legs without current: the ends at the temperatures of display and sink, °C, and the mean half
    /// way between.
    pub fn between_display_and_sink(display: Celsius, sink: Celsius) -> Self {
        Self { cold: display, hot: sink, mean: (display >> 1u32).saturating_add(sink >> 1u32) }
    }
}

/// Internal model of the display plate and the module's legs in fixed point: the constants of one tile, and the
/// temperatures of the present tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateModel {
    relaxations: [FixedPointRelaxation; RELAXATION_COUNT],
    /// Change of the surface temperature after [`CONTROL_HORIZON_TICKS`] (12 ms), K/W, per watt of pumped heat
    /// (whose effect is subtracted), of Joule heat, and of heat from the finger, each acting during all of this time.
    /// Sum over all relaxations, without the finger's immediate effect (feed-through).
    horizon_gains: HeatInputGains<I6F26>,
    /// Immediate rise of this tile's surface temperature, K, per watt of heat from the finger, within one tick.
    finger_feedthrough: I4F28,
    /// Mean temperature of the legs, °C: the mean of their two ends plus a rise in proportion to the Joule heat, with a
    /// first-order lag of [`LEG_MEAN_TIME_CONSTANT_S`]. Without the lag a ramp of 5 K/s would make the resistance 0.3 %
    /// wrong.
    leg_mean: LowPass,
    /// Temperature of the leg ends at the sink, °C, after the last step of the model.
    hot: Celsius,
    surface: Celsius,
    /// Seebeck coefficient of the whole module, V/K, as a function of the legs' mean temperature.
    seebeck: LinearInLegTemperature<I1F31>,
    /// Electrical resistance of the semiconductor legs without leads and bridge, ohm, as a function of the legs' mean
    /// temperature.
    resistance: LinearInLegTemperature<I8F24>,
    /// Additional current, A (positive cools), that lowers the surface temperature by 1 K after the control horizon of
    /// 12 ms. Computed for legs and surface at 27 °C (300 K).
    current_per_kelvin: I20F12,
}

/// Part of a relaxation's distance to its steady state that decays in a number of ticks.
#[inline(never)]
fn decay(ticks: f64, time_constant_s: f64) -> f64 {
    1.0 - libm::exp(-ticks * TICK_S / time_constant_s)
}

impl PlateModel {
    /// Model with the electrical properties of `module` and the identified dynamics of `tile`. Its temperatures are not
    /// valid until [`Self::initialise_steady_state`]. Computed in floating point, so it is too slow for the control
    /// tick: for start-up and the task that serves the host.
    pub fn new(module: &PeltierModule, tile: &Tile) -> Self {
        let ratios = TileToClassRatios::of(tile);
        // In one loop: `map` unrolls.
        let mut relaxations = [FixedPointRelaxation::ZERO; RELAXATION_COUNT];
        let mut horizon_gains = [0.0; 3];
        for (index, fixed) in relaxations.iter_mut().enumerate() {
            let relaxation = &ratios.scale_relaxation(index);
            *fixed = FixedPointRelaxation::new(relaxation);
            let decay = decay(CONTROL_HORIZON_TICKS, relaxation.time_constant_s);
            for (sum, gain) in horizon_gains.iter_mut().zip(relaxation.gains_k_w) {
                *sum += decay * gain;
            }
        }
        let [pumped_k_w, ..] = horizon_gains;
        Self {
            relaxations,
            horizon_gains: HeatInputGains::new(horizon_gains),
            finger_feedthrough: to_fixed(ratios.finger * FINGER_FEEDTHROUGH_K_W),
            leg_mean: LowPass::new(Coefficient::from_time_constant_s(LEG_MEAN_TIME_CONSTANT_S)),
            hot: DATA_SHEET_TEMPERATURE,
            surface: DATA_SHEET_TEMPERATURE,
            seebeck: LinearInLegTemperature::new(module.seebeck_v_k, SEEBECK_RISE_PER_K),
            resistance: LinearInLegTemperature::new(module.legs_ohm, RESISTIVITY_RISE_PER_K),
            current_per_kelvin: to_fixed(1.0 / (pumped_k_w * module.seebeck_v_k * 300.0)),
        }
    }

    /// Sets the model to a steady state with this `surface` temperature, °C, under a constant `current`, A (positive
    /// cools), heat flow from the finger, W, and temperature of the sink, °C. The slowest relaxation takes the part of
    /// the surface temperature that these inputs do not explain. The legs start with hot ends at the sink's temperature
    /// and without Joule heating, as is right for zero current. Returns the inputs of the first tick.
    pub fn initialise_steady_state(
        &mut self,
        surface: Celsius,
        current: Current,
        finger: Watt,
        sink: Celsius,
    ) -> PlateInputs {
        (self.hot, self.surface) = (sink, surface);
        self.leg_mean.set_output(LegTemperatures::between_display_and_sink(surface, sink).mean);
        let inputs = self.inputs_of_tick(current, finger, sink);
        let mut remainder = to_model_temperature(surface)
            .saturating_sub(product(inputs.finger, self.finger_feedthrough));
        let [slowest, others @ ..] = &mut self.relaxations;
        for relaxation in others {
            relaxation.state = relaxation.steady_state_gains.added_to(I12F52::ZERO, &inputs);
            remainder -= relaxation.state_temperature();
        }
        slowest.set_state_temperature(remainder);
        inputs
    }

    /// Replaces the constants of the model by those of `other`, after the tile's settings have changed; the present
    /// temperatures stay.
    pub fn set_parameters(&mut self, other: &Self) {
        let previous = *self;
        *self = *other;
        for (relaxation, previous) in self.relaxations.iter_mut().zip(&previous.relaxations) {
            relaxation.state = previous.state;
        }
        self.leg_mean = previous.leg_mean;
        (self.hot, self.surface) = (previous.hot, previous.surface);
    }

    /// Raises the temperature of plate and surface by `by`, K (negative lowers it), without any heat flow, when a new
    /// calibration gives a reading that differs by this much for the same plate. The temperature of the legs' hot ends
    /// stays.
    pub fn shift_plate_temperature(&mut self, by: Celsius) {
        let [slowest, ..] = &mut self.relaxations;
        slowest.state += temperature_to_state(to_model_temperature(by));
        self.surface = self.surface.saturating_add(by);
    }

    /// Modelled temperature of the display's surface in the patch under the finger, °C, after the last step of the
    /// model; without the disturbance that the observer adds.
    pub const fn surface(&self) -> Celsius {
        self.surface
    }

    /// Modelled temperatures of the legs' two ends and their mean, °C, after the last step of the model.
    pub fn leg_end_and_mean_temperatures(&self) -> LegTemperatures {
        LegTemperatures { cold: self.surface, hot: self.hot, mean: self.leg_mean.output() }
    }

    /// Inputs of the model in a tick with this current, A (positive cools), heat flow from the finger, W, and
    /// temperature of the sink, °C. Pumped and Joule heat are limited to ±64 W, the finger's heat to ±8 W, and the sink
    /// to ±100 °C. The pumped heat is computed with the Seebeck coefficient at the mean temperature of the legs, which
    /// takes account of the Thomson heat.
    #[inline(always)]
    pub fn inputs_of_tick(&self, current: Current, finger: Watt, sink: Celsius) -> PlateInputs {
        let above_data_sheet = (self.leg_mean.output())
            .saturating_sub(DATA_SHEET_TEMPERATURE)
            .clamp(-LEG_DEVIATION_FROM_27_C_MAX_MAGNITUDE, LEG_DEVIATION_FROM_27_C_MAX_MAGNITUDE);
        let surface_k = self.surface.saturating_add(ZERO_C_IN_K);
        let peltier_v: I8F24 = product(self.seebeck.at(above_data_sheet), surface_k);
        let current_squared: I8F24 = saturating_product(current, current);
        let heat = |volts_or_ohms: I8F24, factor: I8F24| -> Watt {
            let heat: Watt = saturating_product(volts_or_ohms, factor);
            heat.clamp(-PUMPED_OR_JOULE_HEAT_MAX_MAGNITUDE, PUMPED_OR_JOULE_HEAT_MAX_MAGNITUDE)
        };
        PlateInputs {
            pumped: heat(peltier_v, current),
            joule: heat(self.resistance.at(above_data_sheet), current_squared),
            finger: finger.clamp(-FINGER_HEAT_MAX_MAGNITUDE, FINGER_HEAT_MAX_MAGNITUDE),
            sink: sink.clamp(-SINK_TEMPERATURE_MAX_MAGNITUDE, SINK_TEMPERATURE_MAX_MAGNITUDE),
        }
    }

    /// Additional current, A (positive cools), with which the modelled surface reaches `target`, °C, after the control
    /// horizon of 12 ms; it is to be added to the current from which `inputs` were computed. Assumes that the finger's
    /// heat flow and the sink's temperature stay as in `inputs`, and neglects the change of the Joule heat.
    pub fn additional_current_to_target(&self, target: Celsius, inputs: &PlateInputs) -> Current {
        const FIXED_POINT_ONE: I4F28 = I4F28::ONE;
        let [slowest, ..] = &self.relaxations;
        let mut change = self.surface.wide_mul(FIXED_POINT_ONE)
            - target.wide_mul(FIXED_POINT_ONE)
            - to_model_temperature(inputs.sink).wide_mul(slowest.horizon_change);
        change = self.horizon_gains.added_to(change, inputs);
        for relaxation in &self.relaxations {
            change += relaxation.state_temperature().wide_mul(relaxation.horizon_change);
        }
        let excess: Celsius = saturated(change);
        saturating_product(excess, self.current_per_kelvin)
    }

    /// Advances all temperatures of the model by one tick of 1 ms under the heat flows and the sink temperature
    /// `inputs`.
    #[inline(never)]
    pub fn step(&mut self, inputs: &PlateInputs) {
        let mut surface: ModelTemperature = product(inputs.finger, self.finger_feedthrough);
        let [slowest, ..] = &mut self.relaxations;
        slowest.state -= to_model_temperature(inputs.sink).wide_mul(slowest.tick_change);
        for relaxation in &mut self.relaxations {
            let change = relaxation.state_temperature().wide_mul(relaxation.tick_change);
            relaxation.state = relaxation.tick_gains.added_to(relaxation.state + change, inputs);
            surface += relaxation.state_temperature();
        }
        self.surface = to_celsius(surface);
        let rise: Celsius = product(inputs.joule, LEG_MEAN_RISE_PER_JOULE_HEAT_K_W);
        let between = LegTemperatures::between_display_and_sink(self.surface, self.hot);
        self.leg_mean.update_by_input(between.mean.saturating_add(rise));
        let heat_out = inputs.joule.saturating_add(inputs.pumped);
        let hot_side_rise = product(heat_out, HOT_SIDE_THERMAL_RESISTANCE_K_W);
        self.hot = inputs.sink.saturating_add(hot_side_rise);
    }
}

/// Converts a temperature, °C or K, to the resolution of the model, 1 µK, rounded down.
fn to_model_temperature(temperature: Celsius) -> ModelTemperature {
    ModelTemperature::from_bits(
        temperature.to_bits() >> (Celsius::FRAC_NBITS - ModelTemperature::FRAC_NBITS),
    )
}

/// Converts a temperature of the model to °C or K at the resolution of the readings; saturates. Two saturating additions
/// are two instructions, where [`ModelTemperature::saturating_to_num`], which gives the same, takes fifteen.
fn to_celsius(temperature: ModelTemperature) -> Celsius {
    const { assert!(Celsius::FRAC_NBITS == ModelTemperature::FRAC_NBITS + 2) };
    let doubled = temperature.saturating_add(temperature);
    Celsius::from_bits(doubled.saturating_add(doubled).to_bits())
}
