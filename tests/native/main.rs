//! Tests on the host, without an image: the native engine on the simulated plant, and hardware-free parts of the firmware.

mod assumed_skin;
mod contact_detection;
mod control_law;
mod display_modes;
mod electrical_parameters;
mod fidelity_populations;
mod finger_components;
mod flux_sensor;
mod hold_stability;
mod processor_faults;
mod range_limits;
mod settings_storage;
mod tracking;
mod voltage_feedforward;
mod weak_module;
