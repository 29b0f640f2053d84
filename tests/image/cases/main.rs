//! Tests of the release image on the emulated microcontroller.

mod bring_up;
mod chip;
mod closed_loop;
mod contact_transients;
mod engine_equality;
mod five_finger_faults;
mod five_finger_locks;
mod five_fingers;
mod learner_cost;
mod processor_faults;
mod range_limits;
mod safety;
mod serve;
mod settings_storage;
mod start_up;
mod wire_protocol;
