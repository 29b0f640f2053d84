//! Limits and symmetries of the fixed-point chain.

use contact_model::fixed_point::{
    Celsius, Contact, ContactPair, Depth, Flux, Force, FourierNumber, Log2, MantissaExponent,
    SemiInfinite, Ticks, fourier_number, log2_relative_pressure,
};
use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};

const SKIN_C: Celsius = Celsius::lit("34");
const OBJECT_C: Celsius = Celsius::lit("24");

fn pairings() -> impl Iterator<Item = ContactPair> {
    (MATERIALS.iter()).map(|(_, object)| {
        ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, 1e-3).expect("ordinary")
    })
}

fn at_2_n(pairing: &ContactPair) -> Contact {
    pairing.at_pressure(log2_relative_pressure(Force::lit("2")))
}

fn near(a: Celsius, b: Celsius, units: i32) -> bool {
    a.abs_diff(b).to_bits() <= units as u32
}

#[test]
fn nothing_has_happened_at_time_zero() {
    for pairing in pairings() {
        let at = at_2_n(&pairing).at(0, SKIN_C, OBJECT_C);
        assert_eq!((at.skin(), at.object()), (SKIN_C, OBJECT_C));
        assert!(near(at.display(), pairing.preset(SKIN_C, OBJECT_C), 1));
    }
}

#[test]
fn absent_contact_exchanges_nothing() {
    for pairing in pairings() {
        let absent = pairing.at_pressure(Log2::MIN);
        for elapsed in [0, 1, u32::MAX] {
            let at = absent.at(elapsed, SKIN_C, OBJECT_C);
            assert_eq!(
                (at.skin(), at.object(), at.flux_w_m2()),
                (SKIN_C, OBJECT_C, Flux::ZERO)
            );
        }
    }
}

/// Skin, object and display meet at once, for ever.
#[test]
fn contact_without_resistance_gives_the_interface_temperature() {
    for pairing in pairings() {
        let at = pairing.at_pressure(Log2::MAX).at(1, SKIN_C, OBJECT_C);
        let interface = pairing.interface_temperature(SKIN_C, OBJECT_C);
        for t in [at.skin(), at.object(), at.display()] {
            assert!(near(t, interface, 1), "{t} {interface}");
        }
        // A resistance too small to hold: as large as a flux can be, not wrapped.
        let landing = pairing
            .at_pressure(Log2::MAX)
            .at(0, SKIN_C, OBJECT_C)
            .flux_w_m2();
        assert_eq!(landing, Flux::MAX);
        let landing = pairing
            .at_pressure(Log2::MAX)
            .at(0, OBJECT_C, SKIN_C)
            .flux_w_m2();
        assert_eq!(landing, -Flux::MAX);
    }
}

/// `b² dt` leaves the range of `f64`, on either side.
#[test]
fn ticks_of_any_length_saturate() {
    for (_, object) in &MATERIALS {
        let contact = |tick_s| {
            at_2_n(&ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, tick_s).expect("any tick"))
        };
        let shortest = contact(f64::from_bits(1)).at(1, SKIN_C, OBJECT_C);
        assert_eq!((shortest.skin(), shortest.object()), (SKIN_C, OBJECT_C));
        let longest = contact(f64::MAX).at(1, SKIN_C, OBJECT_C);
        assert!(near(longest.skin(), longest.object(), 1));
    }
}

#[test]
fn response_holds_when_the_tick_counter_is_full() {
    for pairing in pairings() {
        let contact = at_2_n(&pairing);
        let last = contact.at(Ticks::MAX.get(), SKIN_C, OBJECT_C);
        assert_eq!(contact.at(u32::MAX, SKIN_C, OBJECT_C), last);
    }
}

#[test]
fn perfect_contact_cools_from_the_surface_inwards() {
    for (_, object) in &MATERIALS {
        let perfect = SemiInfinite::new(&SKIN, object, 1e-3).expect("ordinary");
        let at = |depth, ticks| {
            let ticks = Ticks::new(ticks).expect("in range");
            perfect.skin_at_depth(depth, ticks, SKIN_C, OBJECT_C)
        };
        let interface = perfect.interface_temperature(SKIN_C, OBJECT_C);
        assert_eq!(at(Depth::ZERO, 1), interface);
        assert_eq!(at(Depth::MAX, 1), SKIN_C);
        // Four hundred times as long, twenty times as deep.
        let one = at(Depth::lit("20"), 1000);
        let other = at(Depth::lit("400"), 400_000);
        assert!(interface < one && one < SKIN_C && near(one, other, 1));
        // Flux falls with the root of time.
        let flux =
            |ticks| perfect.flux_w_m2(Ticks::new(ticks).expect("in range"), SKIN_C, OBJECT_C);
        let ratio = flux(7).to_num::<f64>() / flux(700).to_num::<f64>();
        assert!(flux(7) < 0 && (ratio - 10.0).abs() < 1e-7, "{ratio}");
    }
}

#[test]
fn fourier_number_saturates() {
    let huge = MantissaExponent::from_f64(1e300).expect("normal");
    let tiny = MantissaExponent::from_f64(1e-300).expect("normal");
    assert_eq!(fourier_number(huge, Ticks::ONE), FourierNumber::MAX);
    assert_eq!(fourier_number(tiny, Ticks::MAX), FourierNumber::ZERO);
    assert_eq!(
        fourier_number(MantissaExponent::ONE, Ticks::MAX),
        FourierNumber::from_num(Ticks::MAX.get())
    );
}
