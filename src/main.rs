//! The firmware (RTIC application).
#![no_std]
#![no_main]
