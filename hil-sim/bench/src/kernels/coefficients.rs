//! What `build.rs` derived.
include!(concat!(env!("OUT_DIR"), "/coefficients.rs"));
