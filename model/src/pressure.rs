//! Contact area and pressure of a fingertip from its force (section 6.4.2).
//!
//! The thesis states the mean pressure at five forces. Area is force over stated pressure there, linear in
//! force between the points and constant outside them.

/// Force in N and mean contact pressure in Pa, as stated.
pub const THESIS_PRESSURES: [(f64, f64); 5] = [
    (0.1, 730.0),
    (0.25, 1680.0),
    (0.5, 3140.0),
    (1.0, 5900.0),
    (2.0, 10980.0),
];

/// Contact area in m² of a fingertip pressed with `force_n` (N, not negative); relative error below 1e-15.
#[must_use]
pub fn contact_area_m2(force_n: f64) -> f64 {
    let area = |(force, pressure): (f64, f64)| force / pressure;
    let mut below = THESIS_PRESSURES[0];
    for point in THESIS_PRESSURES {
        if force_n < point.0 {
            let span = point.0 - below.0;
            if span == 0.0 {
                return area(point);
            }
            let part = (force_n - below.0) / span;
            return area(below) + part * (area(point) - area(below));
        }
        below = point;
    }
    area(below)
}

/// Mean contact pressure in Pa under `force_n` (N, not negative); relative error below 1e-15.
#[must_use]
pub fn pressure_pa(force_n: f64) -> f64 {
    force_n / contact_area_m2(force_n)
}
