//! Error budgets: measures the error of each public function, whose bound and domain `docs/figures.toml` states.
//!
//! Origin of the exact values: golden values have 30 digits; `f64` is the reference model, which has budgets of its own.

mod chain;
mod elementary;
mod float;
mod half_spaces;
pub mod sweep;

use documented_figures::assert_figure;

/// Measures the largest error of one step.
type Measure = fn() -> f64;

/// A figure, and what measures the largest error.
const BUDGETS: [(&str, Measure); 30] = [
    ("budget.float_erfcx_f64", float::erfcx_f64),
    ("budget.float_erfcx_f32", float::erfcx_f32),
    ("budget.float_resistance", float::resistance),
    ("budget.float_ratio", float::ratio),
    ("budget.float_temperatures_f64", float::temperatures_f64),
    ("budget.float_flux_f64", float::flux_f64),
    ("budget.float_temperatures_f32", float::temperatures_f32),
    ("budget.float_contact_interior", float::contact_interior),
    ("budget.half_spaces_interface_f64", half_spaces::interface_f64),
    ("budget.half_spaces_depth_f64", half_spaces::depth_f64),
    ("budget.half_spaces_flux_f64", half_spaces::flux_f64),
    ("budget.half_spaces_fourier_f64", half_spaces::fourier_f64),
    ("budget.elementary_kernel", elementary::kernel),
    ("budget.elementary_kernel_anywhere", elementary::kernel_anywhere),
    ("budget.elementary_log2_error", elementary::log2_error),
    ("budget.elementary_exp2_error", elementary::exp2_error),
    ("budget.elementary_rate_from_log2", elementary::rate_from_log2),
    ("budget.elementary_rate_times", elementary::rate_times),
    ("budget.chain_log2_pressure", chain::log2_pressure),
    ("budget.chain_resistance", chain::resistance),
    ("budget.chain_per_tick", chain::per_tick),
    ("budget.chain_ratio", chain::ratio),
    ("budget.chain_weight", chain::weight),
    ("budget.chain_skin", chain::skin),
    ("budget.chain_object", chain::object),
    ("budget.chain_display", chain::display),
    ("budget.chain_display_steep", chain::display_steep),
    ("budget.chain_flux", chain::flux),
    ("budget.chain_preset", chain::preset),
    ("budget.half_spaces_interface_fixed", half_spaces::interface_fixed),
];

#[test]
fn every_function_has_at_most_its_stated_error() {
    for (key, measure) in BUDGETS {
        assert_figure(key, measure());
    }
}
