//! Perfect contact of two half-spaces, without contact resistance (Eq. 3-1 to 3-4).

use fixed::types::{U16F16, U32F32};

use super::properties::{ContactPairError, check, moderate, of_object, of_skin, rate, weight};
use super::{
    Celsius, ErfArgument, Flux, Fraction, Log2, MantissaExponent, Ticks, contact, erf, log2,
};
use crate::material::Material;

/// Depth below the surface, µm: 0 to 65536, resolution 15 pm.
pub type Depth = U16F16;
/// Fourier number, dimensionless, resolution 2^-32; saturates at [`FourierNumber::MAX`].
pub type FourierNumber = U32F32;

/// Parameters of perfect contact between a finger and one material; independent of temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SemiInfinite {
    weight: Fraction,
    /// `log2` of `1 / (2 sqrt(alpha_skin dt))`, 1/µm: the argument of Eq. 3-2 per depth after one tick.
    log2_argument_per_um: Log2,
    /// Heat flux per kelvin after one tick, `w k_skin / sqrt(pi alpha_skin dt)`, W/(m² K) (Eq. 3-3).
    conductance_w_m2k: MantissaExponent,
}

impl SemiInfinite {
    /// Derives the parameters in `f64` for ticks of `tick_s` seconds (any positive number).
    ///
    /// # Errors
    /// A property that is not positive and finite, or an effusivity (J/(m² s^½ K)) or diffusivity (m²/s) of the
    /// skin outside 2^-100 to 2^100.
    pub fn new(skin: &Material, object: &Material, tick_s: f64) -> Result<Self, ContactPairError> {
        check(of_skin(skin))?;
        check(of_object(object))?;
        check([("tick (s)", tick_s)])?;
        let e_skin = moderate(skin.effusivity())?;
        let log2_diffusion = libm::log2(moderate(skin.diffusivity_m2_s())?) + libm::log2(tick_s);
        let weight = weight(e_skin, object.effusivity());
        Ok(Self {
            weight: Fraction::saturating_from_num(weight),
            log2_argument_per_um: Log2::saturating_from_num(
                libm::log2(1e-6) - 1.0 - log2_diffusion / 2.0,
            ),
            conductance_w_m2k: rate(weight * e_skin / libm::sqrt(core::f64::consts::PI * tick_s))?,
        })
    }

    /// Temperature of both surfaces during contact, °C (Eq. 3-1); error below 0.16 µK.
    #[must_use]
    pub fn interface_temperature(&self, skin_c: Celsius, object_c: Celsius) -> Celsius {
        contact::interface(self.weight, skin_c, object_c)
    }

    /// Skin temperature at a depth, °C (Eq. 3-2); error below 0.2 µK + 4e-9 times the temperature difference of
    /// skin and object, at every depth and time, for ticks from 10 µs to 100 ms.
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
        const DEPTH_PLACES: Log2 = Log2::const_from_int(Depth::FRAC_NBITS as i64);
        let log2_argument = log2(depth.to_bits())
            .saturating_sub(DEPTH_PLACES)
            .saturating_add(self.log2_argument_per_um)
            .saturating_sub(log2(elapsed.get()) >> 1);
        let erfc = !erf(saturating_argument(MantissaExponent::from_log2(
            log2_argument,
        )));
        let fraction = contact::fraction_product(self.weight, erfc);
        skin_c.saturating_sub(contact::fraction_of(
            skin_c.saturating_sub(object_c),
            fraction,
        ))
    }

    /// Heat flux in the skin at its surface, W/m² (Eq. 3-3, negative for a cold object); relative error below 2e-9,
    /// and the resolution of [`Flux`]. At landing it is infinite; [`Ticks`] begin at 1.
    #[must_use]
    pub fn flux_w_m2(&self, elapsed: Ticks, skin_c: Celsius, object_c: Celsius) -> Flux {
        let difference = i64::from(object_c.saturating_sub(skin_c).to_bits()) << 32;
        let inverse_root =
            MantissaExponent::from_log2(Log2::ZERO.saturating_sub(log2(elapsed.get()) >> 1));
        contact::flux(difference, self.conductance_w_m2k.times(inverse_root))
    }
}

/// Fourier number after `elapsed` ticks, from `alpha dt / L²` of one tick (Eq. 3-4); relative error below 2^-33,
/// and 2^-32. Bodies are approximated by half-spaces where it is below 0.05.
#[must_use]
pub fn fourier_number(per_tick: MantissaExponent, elapsed: Ticks) -> FourierNumber {
    let product = u64::from(elapsed.get()) * (1 << 32 | u64::from(per_tick.fraction()));
    let exponent = per_tick.exponent();
    FourierNumber::from_bits(if exponent <= 0 {
        product.checked_shr(exponent.unsigned_abs()).unwrap_or(0)
    } else if exponent.unsigned_abs() <= product.leading_zeros() {
        product << exponent
    } else {
        u64::MAX
    })
}

/// Converts, rounded down; saturates.
fn saturating_argument(rate: MantissaExponent) -> ErfArgument {
    let down = ErfArgument::INT_NBITS as i32 - 1 - rate.exponent();
    ErfArgument::from_bits(match down {
        0.. => rate.leading().checked_shr(down.unsigned_abs()).unwrap_or(0),
        _ => u32::MAX,
    })
}
