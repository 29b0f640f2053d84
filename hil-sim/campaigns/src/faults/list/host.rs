//! Faults of the host and unusual lines.

use thermal_device::safety::Fault;
use thermal_sim::scene::FaultKind as Kind;

use crate::faults::fault_case::{broken, harmless, trips};
use crate::faults::{FaultCase, FaultScene, InjectedFault, Symptom};

/// Silence, invalid bytes, floods, and wrong or unwise lines.
pub const FAULT_CASES: &[FaultCase] = &[
    trips(
        broken(Kind::HostSilent),
        &[Symptom::After(2.0)],
        &[Fault::HostSilent],
    )
    .never_at(FaultScene::TESTED),
    harmless(broken(Kind::HostGarbage)),
    // In `Off`, the flood would delay the line that arms the device.
    harmless(broken(Kind::HostFlood)).never_at(&[FaultScene::Off]),
    harmless(InjectedFault::HostLine("hold 60")).at(&[FaultScene::Touched]),
    harmless(InjectedFault::HostLine("object 900")),
    harmless(InjectedFault::HostLine("stream 0")),
    // Without a tuned model the display overshoots the limit of its set-point.
    harmless(InjectedFault::HostLine("object -20"))
        .or_trips(&[Fault::DisplayCold])
        .at(&[FaultScene::Slew, FaultScene::Touched]),
    trips(
        InjectedFault::HostLine("object 60"),
        &[Symptom::Dose],
        &[Fault::Dose, Fault::DisplayHot, Fault::UnlikeModel],
    )
    .at(&[FaultScene::Slew])
    .watched(180.0),
    // With wrong tile parameters a held display overshoots.
    trips(
        InjectedFault::HostLine("set tile 0.5 0.02 0.3 0.5 0.02"),
        &[Symptom::WrongWay, Symptom::DisplayLimit],
        &[
            Fault::Polarity,
            Fault::UnlikeModel,
            Fault::DisplayHot,
            Fault::DisplayCold,
        ],
    ),
    // Another object or assumed finger under a finger is a step of the set-point, as another temperature is.
    harmless(InjectedFault::HostLine("object slab 0.1mm insulated")).at(&[FaultScene::Touched]),
    harmless(InjectedFault::HostLine("finger thesis")).at(&[FaultScene::Touched]),
    // Lines of an upload that never ends, or is not the one that began.
    harmless(InjectedFault::HostLine("upload begin object 1 0.5")),
    harmless(InjectedFault::HostLine("upload commit 00000000")),
];
