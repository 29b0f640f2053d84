"""Words of the serial protocol."""

from __future__ import annotations

from enum import Enum
from typing import Literal, get_args


class State(str, Enum):
    """State of a finger of the device."""

    OFF = "off"
    """Bridge off; nothing has been tested."""
    SELF_TEST = "self-test"
    """The self-test runs."""
    READY = "ready"
    """Bridge off; the self-test has been passed."""
    ARMED = "armed"
    """Display at skin temperature."""
    PRESET = "preset"
    """An object is presented, and no finger is on it."""
    CONTACT = "contact"
    """An object is presented to the finger on it."""
    STIMULUS = "stimulus"
    """The display follows the host: `hold`, `play`, `pulse`."""
    TRIPPED = "tripped"
    """Bridge off; a fault is latched until `clear`."""

    @property
    def is_driven(self) -> bool:
        """Whether the bridge may drive the tile in this state."""
        return self not in (State.OFF, State.READY, State.TRIPPED)

    def __str__(self) -> str:
        return self.value


class EventKind(str, Enum):
    """Kind of an event."""

    LAND = "land"
    """A finger has landed."""
    LIFT = "lift"
    """A finger has lifted."""
    START = "start"
    """A course has started."""
    END = "end"
    """A course has ended by itself."""
    TRIGGER = "trigger"
    """A rising edge at the trigger input."""
    FLUX = "flux"
    """What is known of the finger by its heat flux has changed."""

    def __str__(self) -> str:
        return self.value


Material = Literal[
    # generated: materials
    "copper",
    "bronze",
    "stainless-steel",
    "granite",
    "g10",
    "abs",
    "foam",
    "baf2",
    "zns",
    "aluminium-6061",
    # /generated
]
"""Materials that the device knows by name."""

AssumedFinger = Literal[
    # generated: assumed-fingers
    "mean",
    "mean-on-pad",
    "thesis",
    # /generated
]
"""Finger that the device assumes for the one that touches."""

FingerKnowledge = Literal[
    # generated: finger-knowledge
    "learning",
    "trusted",
    "no-code",
    "sensor-range",
    "sensor",
    "between",
    "wet",
    "contact",
    "unexplained",
    "arithmetic",
    "late",
    # /generated
]
"""What is known of the finger by its heat flux. With all but the first two, set-points assume the finger of `assume_finger`."""

ContactMode = Literal[
    # generated: contact-modes
    "contact",
    "semi-infinite",
    # /generated
]
"""Set-point with contact resistance, or for perfect contact."""

Law = Literal[
    # generated: laws
    "pi-10hz",
    "pi",
    "model",
    # /generated
]
"""Control law."""

PlayStart = Literal[
    # generated: course-starts
    "now",
    "trigger",
    "landing",
    # /generated
]
"""When a course starts: in the next tick, at the trigger input, or when the next finger lands."""

PlayEnd = Literal[
    # generated: course-ends
    "hold",
    "neutral",
    # /generated
]
"""What follows a course: its last temperature, or skin temperature in the state `armed`."""

SlabBack = Literal["insulated", "held"]
"""What is behind a slab: no heat passes, or the temperature stays."""

TriggerEvent = Literal[
    # generated: trigger-events
    "land",
    "lift",
    "start",
    "end",
    "flux",
    # /generated
]
"""Events that can give a pulse at the trigger output."""

Thermistor = Literal[
    # generated: thermistors
    "display",
    "check",
    "sink",
    "skin",
    "room",
    # /generated
]
"""Thermistors; `check` is the second one of the display."""

TelemetryField = Literal[
    # generated: telemetry-fields
    "setpoint",
    "display",
    "sink",
    "skin",
    "room",
    "force",
    "demand",
    "current",
    "evaluations",
    "flux",
    "surface",
    "finger",
    "check",
    # /generated
]
"""Fields of telemetry that `stream` can choose, in the order of a line."""

ALL_FIELDS: tuple[TelemetryField, ...] = get_args(TelemetryField)
"""All fields, in the order of a line."""

FLUX_FIELDS: tuple[TelemetryField, ...] = (
    # generated: flux-fields
    "flux",
    "surface",
    "finger",
    # /generated
)
"""The fields of the heat-flux sensor, which follow the others in a line if they are chosen: flux, estimate of the display's
surface, and what is known of the finger."""

TELEMETRY_FIELDS: tuple[TelemetryField, ...] = (
    # generated: default-fields
    "setpoint",
    "display",
    "sink",
    "skin",
    "room",
    "force",
    "demand",
    "current",
    "evaluations",
    # /generated
)
"""The fields of a line if none is chosen, in its order."""
