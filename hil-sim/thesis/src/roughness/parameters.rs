//! Levelling, RMS roughness and slopes of a profile.

/// Points on each side that determine a local slope; fewer at the ends of the profile.
const NEIGHBOURS: usize = 3;

/// Heights above the least-squares line, m.
pub(super) fn levelled(x_m: &[f64], z_m: &[f64]) -> Vec<f64> {
    // Relative to the first point, so that a flat profile gives exact zeros.
    let z_m: Vec<f64> = z_m.iter().map(|z| z - z_m[0]).collect();
    let (middle, level) = (mean(x_m, x_m), mean(x_m, &z_m));
    let from_middle: Vec<f64> = x_m.iter().map(|x| x - middle).collect();
    let square = from_middle.iter().map(|x| x * x);
    let product = from_middle.iter().zip(&z_m).map(|(x, z)| x * (z - level));
    let tilt = mean(x_m, &product.collect::<Vec<_>>()) / mean(x_m, &square.collect::<Vec<_>>());
    let above = from_middle.iter().zip(&z_m).map(|(x, z)| z - level - tilt * x);
    above.collect()
}

/// RMS value over the length.
pub(super) fn rms(x_m: &[f64], values: &[f64]) -> f64 {
    let squares: Vec<f64> = values.iter().map(|value| value * value).collect();
    mean(x_m, &squares).sqrt()
}

/// RMS value of the local slopes, m/m.
pub(super) fn rms_slope(x_m: &[f64], y_m: &[f64]) -> f64 {
    let last = x_m.len() - 1;
    let slope = |i: usize| match i.min(last - i).min(NEIGHBOURS) {
        0 => {
            let step = if i == 0 { [0, 1] } else { [last - 1, last] };
            (y_m[step[1]] - y_m[step[0]]) / (x_m[step[1]] - x_m[step[0]])
        }
        reach => central_slope(&x_m[i - reach..=i + reach], &y_m[i - reach..=i + reach]),
    };
    rms(x_m, &(0..=last).map(slope).collect::<Vec<_>>())
}

/// Mean over the length of the absolute inclination, rad.
pub(super) fn mean_slope_rad(x_m: &[f64], y_m: &[f64]) -> f64 {
    let steps = x_m.windows(2).zip(y_m.windows(2));
    let inclined = steps.map(|(x, y)| {
        let step_m = x[1] - x[0];
        step_m * ((y[1] - y[0]) / step_m).atan().abs()
    });
    inclined.sum::<f64>() / (x_m[x_m.len() - 1] - x_m[0])
}

/// Mean over the length of a piecewise linear function.
fn mean(x_m: &[f64], values: &[f64]) -> f64 {
    let steps = x_m.windows(2).zip(values.windows(2));
    let area: f64 = steps.map(|(x, value)| (x[1] - x[0]) * 0.5 * (value[0] + value[1])).sum();
    area / (x_m[x_m.len() - 1] - x_m[0])
}

/// Derivative, at the middle point, of the polynomial through all points.
fn central_slope(x_m: &[f64], y_m: &[f64]) -> f64 {
    let middle = x_m.len() / 2;
    // Barycentric: 1 over the product of distances to all other points.
    let weight = |i: usize| {
        let distances = (x_m.iter().enumerate()).filter(|(j, _)| *j != i);
        distances.map(|(_, x)| x_m[i] - x).product::<f64>().recip()
    };
    let others = (0..x_m.len()).filter(|i| *i != middle);
    let rises = others.map(|i| weight(i) * (y_m[i] - y_m[middle]) / (x_m[middle] - x_m[i]));
    rises.sum::<f64>() / weight(middle)
}
