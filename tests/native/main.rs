//! Tests on the host, without an image: the native engine on the simulated plant, and hardware-free parts of the firmware.

mod bridge_driver;
mod command_mailbox;
mod contact_detection;
mod control_law;
mod display_modes;
mod hold_stability;
mod processor_faults;
mod range_limits;
mod settings_storage;
mod watchdog_feeding;
mod weak_module;
