"""What the device answers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeVar, cast

from .words import ContactMode, FingerKnowledge, State

Reply = TypeVar("Reply")


class Fields:
    """The words of an answer after `ok`."""

    def __init__(self, text: str) -> None:
        self.text = text.strip()
        self.words = self.text.split()
        self._named: dict[str, str] = {}
        for word in self.words:
            name, equals, value = word.partition("=")
            if equals:
                self._named.setdefault(name, value)

    def optional(self, name: str) -> str | None:
        """The word behind `name=`, or `None`."""
        return self._named.get(name)

    def word(self, name: str) -> str:
        """The word behind `name=`."""
        word = self._named.get(name)
        if word is None:
            raise ValueError(f"{name}= is missing")
        return word

    def integer(self, name: str) -> int:
        """The whole number behind `name=`."""
        return int(self.word(name))

    def real(self, name: str) -> float:
        """The finite number behind `name=`."""
        value = float(self.word(name))
        if not math.isfinite(value):
            raise ValueError(f"{name} is not finite")
        return value

    def real_or_none(self, name: str) -> float | None:
        """The number behind `name=`; `None` for `-`."""
        return None if self.word(name) == "-" else self.real(name)

    def flag(self, name: str) -> bool:
        """`0` or `1` behind `name=`."""
        return {"0": False, "1": True}[self.word(name)]


FINGERS_MAX = 5
"""Most fingers of a device."""


@dataclass(frozen=True)
class Identity:
    """Answer to `id`."""

    name: str
    version: str
    fingers: int
    tick_hz: int
    """Control ticks per second."""
    scan_hz: int
    """Scans of all sensors per second."""
    protocol: int | None
    """Version of the protocol; `None` from firmware that does not report it."""
    capabilities: tuple[str, ...]

    @classmethod
    def read(cls, reply: Fields) -> Identity:
        fingers = reply.integer("fingers")
        # A damaged number would let this end wait for fingers that are not there, or for none.
        if not 1 <= fingers <= FINGERS_MAX:
            raise ValueError("fingers")
        protocol = reply.optional("protocol")
        capabilities = reply.optional("capabilities") or ""
        return cls(
            name=reply.words[0],
            version=reply.words[1],
            fingers=fingers,
            tick_hz=reply.integer("tick_hz"),
            scan_hz=reply.integer("scan_hz"),
            protocol=None if protocol is None else int(protocol),
            capabilities=tuple(word for word in capabilities.split(",") if word),
        )

    def can(self, capability: str) -> bool:
        """Whether the firmware has this capability."""
        return capability in self.capabilities


@dataclass(frozen=True)
class Status:
    """Answer to `state`."""

    state: State
    fault: str | None
    """The fault by which the device is tripped."""
    material: str | None
    """Material of the object; `None` before one is chosen."""
    object_c: float | None
    """Temperature of the object before contact, °C; `None` for that of the room."""
    mode: ContactMode
    setpoint_c: float | None
    """Set-point, °C; `None` in a state without one."""
    limited: bool
    """Whether the set-point was clamped, or the display is off it in a stimulus."""
    body: str
    """`half-space`, `slab` or `upload`."""
    tuned: bool | None
    """Whether the tile was identified; if not, set-points are limited to 20 to 38 °C and 1 K/s. `None` from firmware
    without the capability `untuned`."""

    @classmethod
    def read(cls, reply: Fields) -> Status:
        fault, material, object_c = (reply.word(name) for name in ("fault", "material", "object_c"))
        return cls(
            state=State(reply.word("state")),
            fault=None if fault == "-" else fault,
            material=None if material == "-" else material,
            object_c=None if object_c == "room" else reply.real("object_c"),
            mode=cast(ContactMode, reply.word("mode")),
            setpoint_c=reply.real_or_none("setpoint_c"),
            limited="limited" in reply.words,
            body=reply.word("body"),
            tuned=None if (tile := reply.optional("tile")) is None else tile == "tuned",
        )


@dataclass(frozen=True)
class Cause:
    """Answer to `cause`: why the device tripped, now or the last time."""

    fault: str
    tick: int
    """Tick of the trip, ms since reset."""
    display_c: float | None
    check_c: float | None
    """Second display thermistor, °C."""
    sink_c: float | None
    current_a: float
    """Magnitude of the measured current, A."""
    asked_a: float
    """Demanded current, A; positive cools."""

    @classmethod
    def read(cls, reply: Fields) -> Cause | None:
        if reply.word("cause") == "-":
            return None
        return cls(
            fault=reply.word("cause"),
            tick=reply.integer("tick"),
            display_c=reply.real_or_none("display_c"),
            check_c=reply.real_or_none("check_c"),
            sink_c=reply.real_or_none("sink_c"),
            current_a=reply.real("current_a"),
            asked_a=reply.real("asked_a"),
        )

    def summary(self) -> str:
        """Tick and readings in words."""

        def celsius(value: float | None) -> str:
            return "unknown" if value is None else f"{value:.2f} °C"

        return (
            f"tick {self.tick}, display {celsius(self.display_c)}, check {celsius(self.check_c)}, "
            f"sink {celsius(self.sink_c)}, current {self.current_a:.2f} A, asked {self.asked_a:.2f} A"
        )


@dataclass(frozen=True)
class SelfTestReport:
    """Answer to `self-test`; `None` for what was not reached."""

    hot_cut_ms: float | None
    """Time from the comparator's test at its hot side to nFAULT low, ms."""
    hot_supply_v: float | None
    """Supply at the end of that test, V."""
    hot_release_ms: float | None
    """Time from the end of that test to nFAULT high, ms."""
    cold_cut_ms: float | None
    cold_supply_v: float | None
    cold_release_ms: float | None
    side: str | None
    """Line that selects the side: `ok`, or `low` or `high` where it is stuck."""
    supply_v: float | None
    """Supply after both tests, V."""
    cool_a: float | None
    """Mean current of the cooling pulse, A."""
    warm_a: float | None
    """Mean current of the warming pulse, A."""
    display_k: float | None
    """Fall of the first display thermistor, K."""
    check_k: float | None
    """Fall of the second one, K."""
    result: str
    """`passed`, `running`, `none`, or the fault."""
    flux: str | None
    """Heat-flux sensor: `ok`, `no-code`, `sensor-range`, `zero` or `touched`; `None` without one, and before a self-test has passed."""

    @classmethod
    def read(cls, reply: Fields) -> SelfTestReport:
        side = reply.optional("side")
        return cls(
            hot_cut_ms=reply.real_or_none("hot_cut_ms"),
            hot_supply_v=reply.real_or_none("hot_supply_v"),
            hot_release_ms=reply.real_or_none("hot_release_ms"),
            cold_cut_ms=reply.real_or_none("cold_cut_ms"),
            cold_supply_v=reply.real_or_none("cold_supply_v"),
            cold_release_ms=reply.real_or_none("cold_release_ms"),
            side=None if side == "-" else side,
            supply_v=reply.real_or_none("supply_v"),
            cool_a=reply.real_or_none("cool_a"),
            warm_a=reply.real_or_none("warm_a"),
            display_k=reply.real_or_none("display_k"),
            check_k=reply.real_or_none("check_k"),
            result=reply.word("result"),
            flux=reply.optional("flux"),
        )


@dataclass(frozen=True)
class RawReadings:
    """Answer to `raw`: means of 16 conversions of the last tick, counts of 4096."""

    display: float
    check: float
    sink: float
    skin: float
    room: float
    force: float
    current: float
    supply: float
    stop: bool
    """Whether the emergency stop is pressed."""
    fault_line: bool
    """Whether nFAULT is low."""

    @classmethod
    def read(cls, reply: Fields) -> RawReadings:
        return cls(
            display=reply.real("display"),
            check=reply.real("check"),
            sink=reply.real("sink"),
            skin=reply.real("skin"),
            room=reply.real("room"),
            force=reply.real("force"),
            current=reply.real("current"),
            supply=reply.real("supply"),
            stop=reply.flag("stop"),
            fault_line=reply.flag("fault_line"),
        )


@dataclass(frozen=True)
class ContactLaw:
    """Conductance of skin and display, `h (P/H)^exponent + gap` with the mean conductance `h` of both surfaces."""

    exponent: float
    """0.3 to 1.5; 0.95 in Eq. 6-8."""
    hardness_pa: float
    """Microhardness `H`, 1e3 to 1e8 Pa."""
    gap_w_m2k: float
    """Conductance of the gap, 0 to 1e5 W/(m² K)."""

    @classmethod
    def read(cls, reply: Fields) -> ContactLaw:
        return cls(reply.real("exponent"), reply.real("hardness_pa"), reply.real("gap_w_m2k"))


@dataclass(frozen=True)
class FluxReport:
    """Answer to `flux`: the heat-flux sensor, and what is known by it."""

    counts_per_w_m2: float
    """Gain, counts of 4096 per W/m²."""
    zero_counts: float
    """Code without flux."""
    lag_ms: float
    resistance_mm2k_w: float
    """Thermal resistance, mm² K/W."""
    w_m2: float | None
    """Flux out of the finger in the last tick, W/m²; `None` for a code that cannot be right."""
    finger: FingerKnowledge

    @classmethod
    def read(cls, reply: Fields) -> FluxReport | None:
        if reply.word("flux") == "none":
            return None
        return cls(
            counts_per_w_m2=reply.real("counts_per_w_m2"),
            zero_counts=reply.real("zero_counts"),
            lag_ms=reply.real("lag_ms"),
            resistance_mm2k_w=reply.real("resistance_mm2k_w"),
            w_m2=reply.real_or_none("w_m2"),
            finger=cast(FingerKnowledge, reply.word("finger")),
        )


@dataclass(frozen=True)
class PersonReport:
    """Answer to `person` and `person enrol`: who touches, and what is known of the finger."""

    code: str | None
    """1 to 8 of A-Z and 0-9; `None` for an unknown person."""
    contacts: int
    """Contacts of 8 s or more, trusted to their end, since learning has begun."""
    data: str | None
    """What is stored of the finger, 40 hexadecimal digits; `None` for an unknown person."""

    @classmethod
    def read(cls, reply: Fields) -> PersonReport:
        code = reply.word("person")
        known = code != "none"
        return cls(
            code=code if known else None,
            contacts=reply.integer("contacts"),
            data=reply.word("data") if known else None,
        )


@dataclass(frozen=True)
class DisplaySurface:
    """Answer to `surface`: the surface of the display."""

    conductivity_w_mk: float
    roughness_um: float
    """RMS roughness, µm."""
    slope_rad: float
    """Mean slope of the asperities, rad."""

    @classmethod
    def read(cls, reply: Fields) -> DisplaySurface:
        return cls(
            conductivity_w_mk=reply.real("conductivity_w_mk"),
            roughness_um=reply.real("roughness_um"),
            slope_rad=reply.real("slope_rad"),
        )


SIMULATED_UID = "53494D55"
"""First word of the unique identifier of a simulated microcontroller: a real one has its place on the wafer there."""


@dataclass(frozen=True)
class BoardReport:
    """Answer to `board`."""

    bor: int
    """Brown-out level of the option bytes, 0 (off) to 3."""
    watchdogs: str
    """`running`, or `frozen` by a debugger."""
    clock: str
    """`hse` (external) or `hsi` (internal)."""
    pwm_lock: int
    """Level of the lock of the PWM timers' settings, 0 to 3."""
    reset: str
    """Cause of the last reset, such as `power-on`."""
    rx_overruns: int
    rx_framing: int
    rx_noise: int
    tx_dropped: int
    """Lines of telemetry that the device dropped because the line was too slow."""
    uid: str | None
    """Unique identifier of the microcontroller."""
    program: str | None
    """Digest of the program in its flash, which tells one build from another, in hexadecimal digits; `None` if it has none."""

    @property
    def simulated(self) -> bool:
        """Whether the microcontroller is a simulated one, as its identifier says, whatever line leads to it."""
        return self.uid is not None and self.uid.startswith(SIMULATED_UID)

    @classmethod
    def read(cls, reply: Fields) -> BoardReport:
        return cls(
            bor=reply.integer("bor"),
            watchdogs=reply.word("watchdogs"),
            clock=reply.word("clock"),
            pwm_lock=reply.integer("pwm_lock"),
            reset=reply.word("reset"),
            rx_overruns=reply.integer("rx_overruns"),
            rx_framing=reply.integer("rx_framing"),
            rx_noise=reply.integer("rx_noise"),
            tx_dropped=reply.integer("tx_dropped"),
            uid=reply.optional("uid"),
            program=reply.optional("program"),
        )


@dataclass(frozen=True)
class CalibrationFit:
    """Answer to a calibration point."""

    points: int
    """Points of this thermistor so far."""
    worst_mk: float
    """Largest remaining deviation, mK."""

    @classmethod
    def read(cls, reply: Fields) -> CalibrationFit:
        return cls(points=reply.integer("points"), worst_mk=reply.real("worst_mk"))


@dataclass(frozen=True)
class IdentifiedTile:
    """Answer to `margins` and `tune result`."""

    gain_k_s_a: float
    """Rate of change of the plate per demanded current, K/s per A."""
    joule_per_a: float
    """Relative loss of this gain by Joule heat, 1/A."""
    leak_1_s: float
    """Rate at which the plate relaxes, 1/s."""
    lag_s: float
    """Lag of the display's thermistor, s."""
    dead_s: float
    """Dead time from current to surface, s."""
    phase_deg: float
    """Phase margin, degrees."""
    gain_margin: float
    """Gain margin, as a factor."""

    @classmethod
    def read(cls, reply: Fields) -> IdentifiedTile:
        return cls(
            gain_k_s_a=reply.real("gain"),
            joule_per_a=reply.real("joule"),
            leak_1_s=reply.real("leak"),
            lag_s=reply.real("lag_s"),
            dead_s=reply.real("dead_s"),
            phase_deg=reply.real("phase_deg"),
            gain_margin=reply.real("margin"),
        )
