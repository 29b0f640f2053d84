"""Client of the thermal display: a Peltier tile that feels like a material.

    from thermal_display import Display

    with Display.open("/dev/ttyACM0") as display:
        display.material("copper")
        display.arm(wait_s=5)
        display.start()
        landing = display.events.wait("land", timeout_s=60)

See the README of this package, and docs/protocol.md of the device's repository.
"""

from .device_clock import ClockEstimate, DeviceClock
from .display import Display, Finger
from .errors import (
    BridgeNotOff,
    Closed,
    CommandError,
    DeviceBusy,
    DeviceRestarted,
    DeviceTripped,
    DisplayError,
    EventTimeout,
    Interrupted,
    LineBroken,
    LineDamaged,
    NoAnswer,
    NotSendable,
    NotUnderstood,
    Refused,
    SimulatorMissing,
    StateTimeout,
    TelemetryTimeout,
)
from .events import Event, Events, Trip
from .link import Link, SerialLink, TcpLink
from .replies import (
    BoardReport,
    CalibrationFit,
    Cause,
    ContactLaw,
    DisplaySurface,
    FluxReport,
    IdentifiedTile,
    Identity,
    PersonReport,
    RawReadings,
    SelfTestReport,
    Status,
)
from .simulator import HIL_SIM_VARIABLE, Simulator, find_hil_sim
from .telemetry import TELEMETRY_DTYPE, LineCounts, Sample, Telemetry, TelemetryArray
from .words import (
    FLUX_FIELDS,
    TELEMETRY_FIELDS,
    AssumedFinger,
    ContactMode,
    EventKind,
    FingerKnowledge,
    Law,
    Material,
    PlayEnd,
    PlayStart,
    SlabBack,
    State,
    TelemetryField,
    Thermistor,
    TriggerEvent,
)

__all__ = [
    "AssumedFinger",
    "BoardReport",
    "BridgeNotOff",
    "CalibrationFit",
    "Cause",
    "ClockEstimate",
    "Closed",
    "CommandError",
    "ContactLaw",
    "ContactMode",
    "DeviceBusy",
    "DeviceClock",
    "DeviceRestarted",
    "DeviceTripped",
    "Display",
    "DisplayError",
    "DisplaySurface",
    "Event",
    "EventKind",
    "EventTimeout",
    "Events",
    "Finger",
    "FLUX_FIELDS",
    "FingerKnowledge",
    "FluxReport",
    "HIL_SIM_VARIABLE",
    "IdentifiedTile",
    "Identity",
    "Interrupted",
    "Law",
    "LineBroken",
    "LineCounts",
    "LineDamaged",
    "Link",
    "Material",
    "NoAnswer",
    "NotSendable",
    "NotUnderstood",
    "PersonReport",
    "PlayEnd",
    "PlayStart",
    "RawReadings",
    "Refused",
    "Sample",
    "SelfTestReport",
    "SerialLink",
    "Simulator",
    "SimulatorMissing",
    "SlabBack",
    "State",
    "StateTimeout",
    "Status",
    "TELEMETRY_DTYPE",
    "TELEMETRY_FIELDS",
    "TcpLink",
    "Telemetry",
    "TelemetryArray",
    "TelemetryField",
    "TelemetryTimeout",
    "Thermistor",
    "TriggerEvent",
    "Trip",
    "find_hil_sim",
]
