//! Campaigns on the native engine.

mod identification_survey;
mod matrix;
