//! The table of error budgets: what each public function of the model promises, where, and what was measured.
//!
//! `cargo test --release -p contact-model --test budgets -- --nocapture` prints it; a row over its bound fails.

mod chain;
mod course;
mod elementary;
mod float;
#[path = "../golden/mod.rs"]
mod golden;
mod half_spaces;
mod sweep;

/// One promise.
struct Budget {
    function: &'static str,
    /// Where it holds.
    domain: &'static str,
    /// Worst error allowed, in `unit`.
    bound: f64,
    unit: &'static str,
    /// Against what it is measured: golden values have 30 digits; `f64` is the reference, whose own rows are
    /// here too.
    against: &'static str,
    /// Worst error found.
    how: fn() -> f64,
}

/// Stated error of the kernel for the exact product `n K`, what is cut off from it included, in units of 2^-32. The
/// test `kernel` has what is tighter where scenes live.
const KERNEL_UNITS: f64 = 0.54 + 0.07;
/// The same where it saturates too.
const KERNEL_ANYWHERE_UNITS: f64 = 0.8;
/// Relative error of `b² dt` under a streaming force.
const PER_TICK: f64 = 4e-9;
/// Relative error of the conductance.
const CONDUCTANCE: f64 = 2e-9;
/// Error of `E` in the chain; `E` changes by at most 0.14 per relative change of `b² dt`.
const E_ERROR: f64 = KERNEL_ANYWHERE_UNITS / 4_294_967_296.0 + 0.14 * PER_TICK;
/// The same in µK, for a step of 60 K.
const E_UK: f64 = 60e6 * E_ERROR;

/// Half of the resolution of temperatures, in µK: golden ones are rounded on their way in.
const INPUT_UK: f64 = 0.12;

const MATERIALS: &str = "9 materials, any force";
const RESISTANCES: &str = "R 1e-7..10, dt 10us..100ms, n any, -40..125 C, dT 60 K";
const GOLDEN: &str = "golden";
const F64: &str = "f64, sweep + corners";
const BOTH: &str = "golden; f64, sweep + corners";

#[rustfmt::skip]
const BUDGETS: [Budget; 35] = [
    // Floating point.
    Budget { function: "reference::erfcx f64", domain: "z 0..1e308", bound: 2e-15, unit: "relative", against: GOLDEN, how: float::erfcx_f64 },
    Budget { function: "reference::erfcx f32", domain: "z 0..1e37", bound: 5e-7, unit: "relative", against: BOTH, how: float::erfcx_f32 },
    Budget { function: "reference R f64", domain: "9 materials, 4 pressures", bound: 2e-15, unit: "relative", against: GOLDEN, how: float::resistance },
    Budget { function: "reference::Contact f64: r", domain: "thesis's conditions", bound: 2e-15, unit: "relative", against: GOLDEN, how: float::ratio },
    Budget { function: "reference::Response f64: temperatures", domain: "thesis's conditions, t 0..1 h", bound: 1e-7, unit: "uK", against: GOLDEN, how: float::temperatures_f64 },
    Budget { function: "reference::Response f64: flux", domain: "thesis's conditions, t 0..1 h", bound: 5e-15, unit: "relative", against: GOLDEN, how: float::flux_f64 },
    Budget { function: "reference::Response f32: temperatures", domain: "thesis's conditions, t 0..1 h", bound: 10.0, unit: "uK", against: GOLDEN, how: float::temperatures_f32 },
    Budget { function: "reference::Contact::skin_at_depth f64", domain: "depth 0..10 mm, t 10 ms..10 s", bound: 1e-7, unit: "uK", against: GOLDEN, how: float::contact_interior },
    Budget { function: "reference Eq. 3-1 f64", domain: "9 materials", bound: 1e-7, unit: "uK", against: GOLDEN, how: half_spaces::interface_f64 },
    Budget { function: "reference Eq. 3-2 f64", domain: "depth 0..10 mm, t 1 ms..10 s", bound: 1e-7, unit: "uK", against: GOLDEN, how: half_spaces::depth_f64 },
    Budget { function: "reference Eq. 3-3 f64", domain: "t 1 ms..10 s", bound: 1e-13, unit: "relative", against: GOLDEN, how: half_spaces::flux_f64 },
    Budget { function: "reference Eq. 3-4 f64", domain: "6 materials of Table 3-1, 12.71 mm, 5 s", bound: 0.5, unit: "last digit", against: "thesis", how: half_spaces::fourier_f64 },
    // Fixed point: functions of one number.
    Budget { function: "erfcx", domain: "any n; u = n K 2^-63..2^63", bound: KERNEL_UNITS, unit: "2^-32", against: F64, how: elementary::kernel },
    Budget { function: "erfcx", domain: "any n, K", bound: KERNEL_ANYWHERE_UNITS, unit: "2^-32", against: BOTH, how: elementary::kernel_anywhere },
    Budget { function: "log2", domain: "any above 0", bound: 1.4, unit: "2^-32", against: F64, how: elementary::log2_error },
    Budget { function: "exp2", domain: "any", bound: 1.4, unit: "2^-32", against: F64, how: elementary::exp2_error },
    Budget { function: "erf", domain: "any", bound: 3.0, unit: "2^-32", against: F64, how: elementary::erf_error },
    Budget { function: "MantissaExponent::from_log2", domain: "2^-1000..2^1000", bound: 1.4, unit: "2^-32 relative", against: F64, how: elementary::rate_from_log2 },
    Budget { function: "MantissaExponent::times", domain: "2^-500..2^500", bound: 1.0, unit: "2^-32 relative", against: F64, how: elementary::rate_times },
    Budget { function: "log2_relative_pressure", domain: "any force above 0", bound: 6.0, unit: "2^-32", against: F64, how: chain::log2_pressure },
    // Fixed point: from material and force to outputs.
    Budget { function: "ContactPair, Contact: R", domain: MATERIALS, bound: CONDUCTANCE * 1e9, unit: "1e-9 relative", against: BOTH, how: chain::resistance },
    Budget { function: "ContactPair, Contact: K = b2 dt", domain: MATERIALS, bound: PER_TICK * 1e9, unit: "1e-9 relative", against: BOTH, how: chain::per_tick },
    Budget { function: "ContactPair: r", domain: "9 materials, own ones up to 16", bound: 2.0, unit: "1e-9", against: BOTH, how: chain::ratio },
    Budget { function: "ContactPair: w", domain: "9 materials, own ones", bound: 0.25, unit: "1e-9", against: BOTH, how: chain::weight },
    Budget { function: "Response: skin", domain: RESISTANCES, bound: INPUT_UK + 0.2 + E_UK, unit: "uK", against: BOTH, how: chain::skin },
    Budget { function: "Response: object", domain: RESISTANCES, bound: INPUT_UK + 0.2 + E_UK, unit: "uK", against: BOTH, how: chain::object },
    Budget { function: "Response: display, r up to 2", domain: RESISTANCES, bound: INPUT_UK + 0.6 + 2.0 * E_UK, unit: "uK", against: BOTH, how: chain::display },
    Budget { function: "Response: display, r up to 16", domain: RESISTANCES, bound: 0.6 + 16.0 * E_UK, unit: "uK", against: F64, how: chain::display_steep },
    Budget { function: "Response: flux", domain: RESISTANCES, bound: 1e9 * (E_ERROR + CONDUCTANCE) + 1.0, unit: "1e-9 dT/R", against: BOTH, how: chain::flux },
    Budget { function: "ChordInterpolation: set-point, tolerance 500 uK", domain: "9 materials, 5 forces, dT +-10 K, 1 kHz, 10 s", bound: 500.0, unit: "uK", against: F64, how: course::setpoint },
    Budget { function: "ContactPair: preset", domain: "-40..125 C, dT 60 K", bound: INPUT_UK + 0.3, unit: "uK", against: BOTH, how: chain::preset },
    Budget { function: "Eq. 3-1", domain: "-40..125 C", bound: INPUT_UK + 0.16, unit: "uK", against: BOTH, how: half_spaces::interface_fixed },
    Budget { function: "Eq. 3-2", domain: "any depth, n; dt 10us..100ms, dT 60 K", bound: INPUT_UK + 0.45, unit: "uK", against: BOTH, how: half_spaces::depth_fixed },
    Budget { function: "Eq. 3-3", domain: "any n; dt 10us..100ms, dT from 1 K", bound: 2.0, unit: "1e-9 relative", against: BOTH, how: half_spaces::flux_fixed },
    Budget { function: "Eq. 3-4", domain: "any n; Fo up to 1000", bound: 1.01, unit: "2^-32", against: F64, how: half_spaces::fourier_fixed },
];

#[test]
fn every_function_stays_within_its_stated_error() {
    let mut over = Vec::new();
    println!(
        "{:<42} {:<54} {:>10} {:>10}  {:<15} against",
        "function", "domain", "bound", "measured", "unit"
    );
    for budget in BUDGETS {
        let worst = (budget.how)();
        println!(
            "{:<42} {:<54} {:>10.3e} {worst:>10.3e}  {:<15} {}",
            budget.function, budget.domain, budget.bound, budget.unit, budget.against
        );
        if worst.is_nan() || worst > budget.bound {
            over.push(format!(
                "{}: {worst:e} {}, allowed {:e}",
                budget.function, budget.unit, budget.bound
            ));
        }
    }
    assert!(over.is_empty(), "{over:#?}");
}
