//! Perfect contact of two half-spaces, Eq. 3-1 to 3-4: the limit of no contact resistance.

use fixed::types::{U16F16, U32F32};

use super::properties::{ContactPairError, check, moderate, of_object, of_skin, rate, weight};
use super::{
    Celsius, ErfArgument, Flux, Fraction, Log2, MantissaExponent, Ticks, contact, erf, log2,
};
use crate::material::Material;

/// Depth in µm: 0 to 65536 at a resolution of 15 pm.
pub type Depth = U16F16;
/// Fourier number at a resolution of 2^-32; [`FourierNumber::MAX`] stands for everything above.
pub type FourierNumber = U32F32;

/// A finger in perfect contact with one material; does not change with temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SemiInfinite {
    weight: Fraction,
    /// `1 / (2 sqrt(alpha_skin dt))`, 1/µm.
    log2_reach: Log2,
    /// `w k_skin / sqrt(pi alpha_skin dt)`, W/(m² K).
    conductance_w_m2k: MantissaExponent,
}

impl SemiInfinite {
    /// Derives the numbers, in `f64`, for ticks of `tick_s` seconds (any above 0).
    ///
    /// # Errors
    /// A property that is not positive and finite, or an effusivity or diffusivity of the skin beyond 2^±100.
    pub fn new(skin: &Material, object: &Material, tick_s: f64) -> Result<Self, ContactPairError> {
        check(of_skin(skin))?;
        check(of_object(object))?;
        check([("tick (s)", tick_s)])?;
        let e_skin = moderate(skin.effusivity())?;
        let spread = libm::log2(moderate(skin.diffusivity_m2_s())?) + libm::log2(tick_s);
        let weight = weight(e_skin, object.effusivity());
        Ok(Self {
            weight: Fraction::saturating_from_num(weight),
            log2_reach: Log2::saturating_from_num(libm::log2(1e-6) - 1.0 - spread / 2.0),
            conductance_w_m2k: rate(weight * e_skin / libm::sqrt(core::f64::consts::PI * tick_s))?,
        })
    }

    /// Temperature of both surfaces from landing on (Eq. 3-1); error below 0.16 µK.
    #[must_use]
    pub fn interface_temperature(&self, skin_c: Celsius, object_c: Celsius) -> Celsius {
        contact::interface(self.weight, skin_c, object_c)
    }

    /// Skin temperature at a depth (Eq. 3-2); error below 0.2 µK + 4e-9 of the difference of the temperatures,
    /// for every depth and time and ticks from 10 µs to 100 ms.
    #[must_use]
    pub fn skin_at_depth(
        &self,
        depth: Depth,
        elapsed: Ticks,
        skin_c: Celsius,
        object_c: Celsius,
    ) -> Celsius {
        if depth == Depth::ZERO {
            return self.interface_temperature(skin_c, object_c);
        }
        const UNITS: Log2 = Log2::const_from_int(Depth::FRAC_NBITS as i64);
        let log2_argument = log2(depth.to_bits())
            .saturating_sub(UNITS)
            .saturating_add(self.log2_reach)
            .saturating_sub(log2(elapsed.get()) >> 1);
        let gone = !erf(argument(MantissaExponent::from_log2(log2_argument)));
        let gain = contact::product(self.weight, gone);
        skin_c.saturating_sub(contact::part(skin_c.saturating_sub(object_c), gain))
    }

    /// Heat flux in the skin at its surface, signed as Eq. 3-3 has it: negative for a cold object. Relative error
    /// below 2e-9, and the resolution of [`Flux`]. At time zero it is infinite; [`Ticks`] begin after it.
    #[must_use]
    pub fn flux_w_m2(&self, elapsed: Ticks, skin_c: Celsius, object_c: Celsius) -> Flux {
        let step = i64::from(object_c.saturating_sub(skin_c).to_bits()) << 32;
        let inverse_root =
            MantissaExponent::from_log2(Log2::ZERO.saturating_sub(log2(elapsed.get()) >> 1));
        contact::flux(step, self.conductance_w_m2k.times(inverse_root))
    }
}

/// The Fourier number after `elapsed` ticks from that of one tick, `alpha dt / L²` (Eq. 3-4); error below
/// 2^-33 of itself + 2^-32. The bodies count as half-spaces below 0.05.
#[must_use]
pub fn fourier_number(rate_per_tick: MantissaExponent, elapsed: Ticks) -> FourierNumber {
    let product = u64::from(elapsed.get()) * (1 << 32 | u64::from(rate_per_tick.fraction()));
    let exponent = rate_per_tick.exponent();
    FourierNumber::from_bits(if exponent <= 0 {
        product.checked_shr(exponent.unsigned_abs()).unwrap_or(0)
    } else if exponent.unsigned_abs() <= product.leading_zeros() {
        product << exponent
    } else {
        u64::MAX
    })
}

/// Rounded down; saturates.
fn argument(rate: MantissaExponent) -> ErfArgument {
    let down = ErfArgument::INT_NBITS as i32 - 1 - rate.exponent();
    ErfArgument::from_bits(match down {
        0.. => rate.leading().checked_shr(down.unsigned_abs()).unwrap_or(0),
        _ => u32::MAX,
    })
}
