//! The infrared instrument against golden values.

mod infrared;
