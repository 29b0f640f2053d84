//! Uniform tables in `z` up to 16, then the asymptotic series.
use super::coefficients::{UNIFORM_1024, UNIFORM_4096, UNIFORM_16384};
use super::root::sqrt;

/// Linear interpolation, 1024 nodes.
pub(super) fn linear_4(elapsed: u32, per_tick: f32) -> f32 {
    linear(&UNIFORM_1024, elapsed, per_tick)
}

/// Linear interpolation, 4096 nodes.
pub(super) fn linear_16(elapsed: u32, per_tick: f32) -> f32 {
    linear(&UNIFORM_4096, elapsed, per_tick)
}

/// Linear interpolation, 16384 nodes.
pub(super) fn linear_64(elapsed: u32, per_tick: f32) -> f32 {
    linear(&UNIFORM_16384, elapsed, per_tick)
}

/// Quadratic interpolation, 1024 nodes.
pub(super) fn quadratic_4(elapsed: u32, per_tick: f32) -> f32 {
    quadratic(&UNIFORM_1024, elapsed, per_tick)
}

/// Quadratic interpolation, 4096 nodes.
pub(super) fn quadratic_16(elapsed: u32, per_tick: f32) -> f32 {
    quadratic(&UNIFORM_4096, elapsed, per_tick)
}

/// Quadratic interpolation, 16384 nodes.
pub(super) fn quadratic_64(elapsed: u32, per_tick: f32) -> f32 {
    quadratic(&UNIFORM_16384, elapsed, per_tick)
}

#[inline]
fn linear<const N: usize>(table: &[f32; N], elapsed: u32, per_tick: f32) -> f32 {
    let u = elapsed as f32 * per_tick;
    let z = sqrt(u);
    let place = z * (N as f32 / 16.0);
    let index = place as u32 as usize;
    match table.get(index..).and_then(|rest| rest.first_chunk()) {
        Some([here, next]) => here + (place - index as f32) * (next - here),
        None => tail(u, z),
    }
}

/// Through the nearest node and its two neighbours.
#[inline]
fn quadratic<const N: usize>(table: &[f32; N], elapsed: u32, per_tick: f32) -> f32 {
    let u = elapsed as f32 * per_tick;
    let z = sqrt(u);
    let place = z * (N as f32 / 16.0);
    let left = ((place + 0.5) as u32).max(1) as usize - 1;
    match table.get(left..).and_then(|rest| rest.first_chunk()) {
        Some([before, here, after]) => {
            let d = place - (left + 1) as f32;
            here + d * 0.5 * ((after - before) + d * ((before - here) + (after - here)))
        }
        None => tail(u, z),
    }
}

/// `1/(sqrt(pi) z) (1 - 1/(2u) + 3/(4u²))` (Abramowitz and Stegun 7.1.23): off by 4e-9 at `z = 16`, less beyond.
#[inline]
fn tail(u: f32, z: f32) -> f32 {
    let w = 1.0 / u;
    (0.564_189_6 / z) * (1.0 - w * (0.5 - 0.75 * w))
}
