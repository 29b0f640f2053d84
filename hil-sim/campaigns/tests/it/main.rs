//! Campaigns on the native engine.

mod matrix;
mod survey;
