//! Identification, stability margins and least squares against simulated tiles and published values.

mod cholesky;
mod identification;
mod stability_margins;
