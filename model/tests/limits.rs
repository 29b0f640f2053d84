//! Limits of the fixed-point path: time zero, no contact, no resistance, extreme ticks.

use contact_model::fixed_point::{
    Celsius, Contact, ContactPair, Flux, Force, Log2, Ticks, log2_relative_pressure,
};
use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};

const SKIN_C: Celsius = Celsius::lit("34");
const OBJECT_C: Celsius = Celsius::lit("24");

fn contact_pairs() -> impl Iterator<Item = ContactPair> {
    (MATERIALS.iter()).map(|(_, object)| {
        ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, 1e-3).expect("ordinary")
    })
}

fn at_2_n(pair: &ContactPair) -> Contact {
    pair.at_pressure(log2_relative_pressure(Force::lit("2")))
}

fn agree(a: Celsius, b: Celsius, units: i32) -> bool {
    a.abs_diff(b).to_bits() <= units as u32
}

#[test]
fn temperatures_at_time_zero_are_those_before_contact() {
    for pair in contact_pairs() {
        let at = at_2_n(&pair).at(0, SKIN_C, OBJECT_C);
        assert_eq!((at.skin(), at.object()), (SKIN_C, OBJECT_C));
        assert!(agree(at.display(), pair.preset(SKIN_C, OBJECT_C), 1));
    }
}

#[test]
fn no_heat_flows_without_contact() {
    for pair in contact_pairs() {
        let absent = pair.at_pressure(Log2::MIN);
        for elapsed in [0, 1, u32::MAX] {
            let at = absent.at(elapsed, SKIN_C, OBJECT_C);
            assert_eq!((at.skin(), at.object(), at.flux_w_m2()), (SKIN_C, OBJECT_C, Flux::ZERO));
        }
    }
}

#[test]
fn contact_without_resistance_gives_the_interface_temperature_at_once() {
    for pair in contact_pairs() {
        let at = pair.at_pressure(Log2::MAX).at(1, SKIN_C, OBJECT_C);
        let interface = pair.interface_temperature(SKIN_C, OBJECT_C);
        for t in [at.skin(), at.object(), at.display()] {
            assert!(agree(t, interface, 1), "{t} {interface}");
        }
        // A resistance below the range of the type gives the largest flux.
        let landing = pair.at_pressure(Log2::MAX).at(0, SKIN_C, OBJECT_C).flux_w_m2();
        assert_eq!(landing, Flux::MAX);
        let landing = pair.at_pressure(Log2::MAX).at(0, OBJECT_C, SKIN_C).flux_w_m2();
        assert_eq!(landing, -Flux::MAX);
    }
}

/// `b² dt` exceeds the range of `f64` at both ends.
#[test]
fn ticks_of_any_length_saturate() {
    for (_, object) in &MATERIALS {
        let contact = |tick_s| {
            at_2_n(&ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, tick_s).expect("any tick"))
        };
        let shortest = contact(f64::from_bits(1)).at(1, SKIN_C, OBJECT_C);
        assert_eq!((shortest.skin(), shortest.object()), (SKIN_C, OBJECT_C));
        let longest = contact(f64::MAX).at(1, SKIN_C, OBJECT_C);
        assert!(agree(longest.skin(), longest.object(), 1));
    }
}

#[test]
fn response_is_constant_after_the_largest_tick_count() {
    for pair in contact_pairs() {
        let contact = at_2_n(&pair);
        let last = contact.at(Ticks::MAX.get(), SKIN_C, OBJECT_C);
        assert_eq!(contact.at(u32::MAX, SKIN_C, OBJECT_C), last);
    }
}
