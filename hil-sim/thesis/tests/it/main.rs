//! The recomputed thesis and the roughness of profiles, against golden values.

mod roughness;
mod thesis;
