//! The course of set-points.

use contact_model::fixed_point::{
    Celsius, ChordInterpolation, ContactPair, Force, log2_relative_pressure,
};
use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
use contact_model::pressure::THESIS_PRESSURES;
use contact_model::reference::Contact;

use crate::sweep::worst;

/// Error in µK for a tolerance of 500 µK: nine materials, five forces, colder and warmer than the skin, each tick of 10 s.
pub fn setpoint() -> f64 {
    const SKIN_C: f64 = 34.0;
    worst(MATERIALS.iter().flat_map(|(_, object)| {
        let pairing = ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, 1e-3).expect("in range");
        THESIS_PRESSURES
            .into_iter()
            .flat_map(move |(force_n, pressure_pa)| {
                let contact = pairing.at_pressure(log2_relative_pressure(Force::from_num(force_n)));
                [24.0, 44.0].into_iter().flat_map(move |object_c| {
                    let celsius = Celsius::from_num::<f64>;
                    let tolerance = celsius(500e-6);
                    let (mut course, _) = ChordInterpolation::new(
                        &contact,
                        celsius(SKIN_C),
                        celsius(object_c),
                        0,
                        tolerance,
                    );
                    let exact = Contact::new(
                        (&SKIN, SKIN_C),
                        (object, object_c),
                        &REFERENCE_DISPLAY,
                        pressure_pa,
                    );
                    (1..=10_000).map(move |tick| {
                        let found: f64 = course.advance().to_num();
                        (found - exact.at(f64::from(tick) * 1e-3).display_c) * 1e6
                    })
                })
            })
    }))
}
