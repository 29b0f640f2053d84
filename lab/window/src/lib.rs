#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod entry;
mod gate;
mod keys;
mod link_quality;
mod model;
mod monitor;
#[cfg(feature = "native")]
mod native;
mod participant;
mod people;
mod silence;
mod stop;
pub mod texts;
mod tone;
mod trace;
#[cfg(feature = "views")]
pub mod views;

pub use entry::NumberEntry;
pub use gate::Gate;
pub use keys::{Action, Key, WindowKind, action};
pub use link_quality::{LinkQuality, ScreenLatency};
pub use model::{End, FingerView, Model, Notice, SessionView, TrialView};
pub use monitor::{MonitorPeople, Order, monitor};
#[cfg(feature = "native")]
pub use native::{Shown, WindowError, WindowOptions, run_window};
pub use participant::{Follow, ParticipantView, ShownCue};
pub use people::{WindowPeople, WindowSide};
pub use stop::StopFlag;
pub use tone::{Tones, wav};
pub use trace::Trace;
