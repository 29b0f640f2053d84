//! The contact model against golden values, which `model/tests/data/generate.py` computes with 30 digits.

include!(concat!(env!("OUT_DIR"), "/golden.rs"));

/// A contact of the golden data.
pub struct GoldenContact {
    material: &'static str,
    pressure_pa: f64,
    t_s: f64,
    skin_before_c: f64,
    object_before_c: f64,
    skin_c: f64,
    object_c: f64,
    display_c: f64,
}

#[embedded_test::tests]
mod tests {
    use core::hint::black_box;

    use contact_model::fixed_point::{
        Celsius, ContactPair, Fraction, Log2, MantissaExponent, Ticks, erfcx,
    };
    use contact_model::material::{
        REFERENCE_DISPLAY, SKIN, SKIN_MICROHARDNESS_PA, THESIS_MATERIALS, find,
    };

    use super::{CONTACTS, ERFCX, GoldenContact};
    use crate::running_board::{feed, set_up};
    use crate::{cycles, report};

    /// Stated error of the kernel and of the bits of `u` that it does not see, units of 2^-32.
    const KERNEL_ERROR_MAX: f64 = 0.51 + 0.07;
    /// Bounds of `docs/contact-model.md`, of `skin` and `object` and of `display`.
    const SKIN_ERROR_MAX_UK: f64 = 0.3648;
    const DISPLAY_ERROR_MAX_UK: f64 = 0.8096;

    /// With call and return, so that its cycles can be told from those around it.
    #[inline(never)]
    fn called_kernel(rate: MantissaExponent) -> Fraction {
        erfcx(Ticks::ONE, rate)
    }

    #[test]
    fn the_kernel_has_its_stated_error_against_golden_values() {
        const UNITS: f64 = 4_294_967_296.0;
        let mut board = set_up();
        let mut costs = cycles::Costs::default();
        let mut worst = 0f64;
        for (u, expected) in ERFCX {
            feed(&mut board);
            let rate = MantissaExponent::from_f64(*u).expect("a rate of the domain");
            let (result, cost) = cycles::measure(|| called_kernel(black_box(rate)));
            costs.add(cost);
            worst = worst.max((f64::from(result.to_bits()) - expected * UNITS).abs());
        }
        report::figure("kernel_error_max", format_args!("{worst:.4}"), "units of 2^-32");
        report::figure("kernel_cycles_mean", costs.mean(), "cycles");
        report::figure("kernel_cycles_max", costs.max, "cycles");
        assert!(ERFCX.len() > 100 && worst <= KERNEL_ERROR_MAX, "{worst}");
    }

    #[test]
    fn contacts_have_their_stated_error_against_golden_values() {
        let mut worst = [0f64; 3];
        let of_thesis = |golden: &&GoldenContact| THESIS_MATERIALS.contains(&golden.material);
        for golden in CONTACTS.iter().filter(of_thesis) {
            let object = find(golden.material).expect("a material of the thesis");
            let pair = ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, golden.t_s);
            let log2_pressure = libm::log2(golden.pressure_pa / SKIN_MICROHARDNESS_PA);
            let response =
                pair.expect("a pair of the thesis").at_pressure(Log2::from_num(log2_pressure)).at(
                    1,
                    Celsius::from_num(golden.skin_before_c),
                    Celsius::from_num(golden.object_before_c),
                );
            let compared = [
                (response.skin(), golden.skin_c),
                (response.object(), golden.object_c),
                (response.display(), golden.display_c),
            ];
            for (worst, (fixed, exact)) in worst.iter_mut().zip(compared) {
                *worst = worst.max(1e6 * (fixed.to_num::<f64>() - exact).abs());
            }
        }
        let [skin, object, display] = worst;
        let [of_skin, of_display] = [skin.max(object), display];
        report::figure("contact_skin_error_max", format_args!("{of_skin:.3}"), "uK");
        report::figure("contact_display_error_max", format_args!("{of_display:.3}"), "uK");
        assert!(CONTACTS.len() > 100);
        assert!(of_skin <= SKIN_ERROR_MAX_UK && of_display <= DISPLAY_ERROR_MAX_UK);
    }
}
