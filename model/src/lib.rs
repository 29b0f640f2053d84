//! Thermal contact of a finger with an object (H.-N. Ho, MIT 2006).
#![no_std]
#![forbid(unsafe_code)]
