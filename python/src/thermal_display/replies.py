"""What the device answers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar, cast

from .words import ContactMode, FingerKnowledge, State

Reply = TypeVar("Reply")
Value = TypeVar("Value")


def real(word: str) -> float:
    """A finite number."""
    value = float(word)
    if not math.isfinite(value):
        raise ValueError(f"{word} is not finite")
    return value


def bit(word: str) -> bool:
    """`1` or `0`."""
    return {"0": False, "1": True}[word]


def whether(yes: str, no: str) -> Callable[[str], bool]:
    """What makes a truth value of one of these words."""
    return lambda word: {yes: True, no: False}[word]


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

    def value(self, name: str, convert: Callable[[str], Value]) -> Value:
        """What `convert` makes of the word behind `name=`."""
        word = self._named.get(name)
        if word is None:
            raise ValueError(f"{name}= is missing")
        return convert(word)

    def or_none(self, name: str, convert: Callable[[str], Value], none: str = "-") -> Value | None:
        """The same, but `None` for this word."""
        return None if self.value(name, str) == none else self.value(name, convert)

    def if_reported(self, name: str, convert: Callable[[str], Value], none: str | None = None) -> Value | None:
        """The same, but `None` also if there is no `name=`: firmware from before it does not report it."""
        return None if self._named.get(name) in (None, none) else self.value(name, convert)

    def whole_within(self, name: str, least: int, most: int) -> int:
        """The whole number behind `name=`, within these limits."""
        number = self.value(name, int)
        if not least <= number <= most:
            raise ValueError(f"{name}={number}; {least} to {most}")
        return number

    def words_behind(self, name: str) -> tuple[str, ...]:
        """The words with commas between them behind `name=`; none if there is no `name=`."""
        return tuple(word for word in self._named.get(name, "").split(",") if word)


@dataclass(frozen=True)
class Identity:
    """Answer to `id`."""

    # generated: Identity
    name: str
    """Name of the firmware."""
    version: str
    """Its version."""
    fingers: int
    """Number of fingers, 1 to 5."""
    tick_hz: int
    """Control ticks per second."""
    scan_hz: int
    """Scans of all sensors per second."""
    protocol: int | None
    """Version of the protocol."""
    capabilities: tuple[str, ...]
    """What this firmware can do beyond the first version of the protocol."""

    @classmethod
    def read(cls, reply: Fields) -> Identity:
        return cls(
            name=reply.words[0],
            version=reply.words[1],
            fingers=reply.whole_within("fingers", 1, 5),
            tick_hz=reply.value("tick_hz", int),
            scan_hz=reply.value("scan_hz", int),
            protocol=reply.if_reported("protocol", int),
            capabilities=reply.words_behind("capabilities"),
        )
    # /generated

    def can(self, capability: str) -> bool:
        """Whether the firmware has this capability."""
        return capability in self.capabilities


@dataclass(frozen=True)
class Status:
    """Answer to `state`."""

    # generated: Status
    state: State
    """State, with the fault if it is tripped."""
    fault: str | None
    """Fault by which the device is tripped."""
    material: str | None
    """Material of the object; unknown before one is chosen."""
    object_c: float | None
    """Temperature of the object before contact, °C, or that of the room."""
    mode: ContactMode
    """Contact model."""
    setpoint_c: float | None
    """Set-point, °C; unknown in a state without one."""
    limited: bool
    """Whether the set-point is not the one that was asked for, because that is out of its range or moves too fast."""
    body: str
    """Body of the object."""
    tuned: bool | None
    """Whether the tile was identified or set; if not, set-points are limited to 20 to 38 °C and 1 K/s."""

    @classmethod
    def read(cls, reply: Fields) -> Status:
        return cls(
            state=State(reply.value("state", str)),
            fault=reply.or_none("fault", str),
            material=reply.or_none("material", str),
            object_c=reply.or_none("object_c", real, "room"),
            mode=cast(ContactMode, reply.value("mode", str)),
            setpoint_c=reply.or_none("setpoint_c", real),
            limited="limited" in reply.words,
            body=reply.value("body", str),
            tuned=reply.if_reported("tile", whether("tuned", "untuned")),
        )
    # /generated


@dataclass(frozen=True)
class Cause:
    """Answer to `cause`: why the device tripped, now or the last time."""

    # generated: Cause
    fault: str
    """Fault."""
    tick: int
    """Tick of the trip, ms since reset."""
    display_c: float | None
    """First display thermistor, °C."""
    check_c: float | None
    """Second display thermistor, °C."""
    sink_c: float | None
    """Thermistor of the heat sink, °C."""
    current_a: float
    """Magnitude of the measured current, A."""
    asked_a: float
    """Demanded current, A; positive cools."""

    @classmethod
    def read(cls, reply: Fields) -> Cause | None:
        if reply.value("cause", str) == "-":
            return None
        return cls(
            fault=reply.value("cause", str),
            tick=reply.value("tick", int),
            display_c=reply.or_none("display_c", real),
            check_c=reply.or_none("check_c", real),
            sink_c=reply.or_none("sink_c", real),
            current_a=reply.value("current_a", real),
            asked_a=reply.value("asked_a", real),
        )
    # /generated

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

    # generated: SelfTestReport
    hot_cut_ms: int | None
    """Time from the comparator's test at its hot side to nFAULT low, ms."""
    hot_supply_v: float | None
    """Supply at the end of that test, V."""
    hot_release_ms: int | None
    """Time from the end of that test to nFAULT high, ms."""
    cold_cut_ms: int | None
    """Time from the comparator's test at its cold side to nFAULT low, ms."""
    cold_supply_v: float | None
    """Supply at the end of that test, V."""
    cold_release_ms: int | None
    """Time from the end of that test to nFAULT high, ms."""
    side: str | None
    """Line that selects the side of these tests, or the level at which it is stuck."""
    supply_v: float | None
    """Supply after both tests, V."""
    cool_a: float | None
    """Mean current of the cooling pulse, A."""
    warm_a: float | None
    """Mean current of the warming pulse, A."""
    display_k: float | None
    """Fall of the first display thermistor by the cooling pulse, K."""
    check_k: float | None
    """Fall of the second display thermistor by the cooling pulse, K."""
    result: str
    """Result: passed, running, none, or the fault."""
    flux: str | None
    """Heat-flux sensor; not reported without one, and before a self-test has passed."""

    @classmethod
    def read(cls, reply: Fields) -> SelfTestReport:
        return cls(
            hot_cut_ms=reply.or_none("hot_cut_ms", int),
            hot_supply_v=reply.or_none("hot_supply_v", real),
            hot_release_ms=reply.or_none("hot_release_ms", int),
            cold_cut_ms=reply.or_none("cold_cut_ms", int),
            cold_supply_v=reply.or_none("cold_supply_v", real),
            cold_release_ms=reply.or_none("cold_release_ms", int),
            side=reply.if_reported("side", str, "-"),
            supply_v=reply.or_none("supply_v", real),
            cool_a=reply.or_none("cool_a", real),
            warm_a=reply.or_none("warm_a", real),
            display_k=reply.or_none("display_k", real),
            check_k=reply.or_none("check_k", real),
            result=reply.value("result", str),
            flux=reply.if_reported("flux", str),
        )
    # /generated


@dataclass(frozen=True)
class RawReadings:
    """Answer to `raw`: means of 16 conversions of the last tick, counts of 4096."""

    # generated: RawReadings
    display: float
    """First display thermistor, counts."""
    check: float
    """Second display thermistor, counts."""
    sink: float
    """Thermistor of the heat sink, counts."""
    skin: float
    """Thermistor of the skin, counts."""
    room: float
    """Thermistor of the room, counts."""
    force: float
    """Force sensor, counts."""
    current: float
    """Current mirror of the bridge, counts."""
    supply: float
    """Supply of the bridge, counts."""
    stop: bool
    """Whether the emergency stop is pressed."""
    fault_line: bool
    """Whether nFAULT is low."""

    @classmethod
    def read(cls, reply: Fields) -> RawReadings:
        return cls(
            display=reply.value("display", real),
            check=reply.value("check", real),
            sink=reply.value("sink", real),
            skin=reply.value("skin", real),
            room=reply.value("room", real),
            force=reply.value("force", real),
            current=reply.value("current", real),
            supply=reply.value("supply", real),
            stop=reply.value("stop", bit),
            fault_line=reply.value("fault_line", bit),
        )
    # /generated


@dataclass(frozen=True)
class ContactLaw:
    """Conductance of skin and display, `h (P/H)^exponent + gap` with the mean conductance `h` of both surfaces."""

    # generated: ContactLawReport
    exponent: float
    """Exponent: 0.3 to 1.5."""
    hardness_pa: float
    """Microhardness: 1000 to 100000000 Pa."""
    gap_w_m2k: float
    """Gap: 0 to 100000 W/(m2 K)."""

    @classmethod
    def read(cls, reply: Fields) -> ContactLaw:
        return cls(
            exponent=reply.value("exponent", real),
            hardness_pa=reply.value("hardness_pa", real),
            gap_w_m2k=reply.value("gap_w_m2k", real),
        )
    # /generated


@dataclass(frozen=True)
class FluxReport:
    """Answer to `flux`: the heat-flux sensor, and what is known by it."""

    # generated: FluxReport
    counts_per_w_m2: float
    """Gain: 0.01 to 1 counts per W/m2."""
    zero_counts: float
    """Zero: 64 to 4031 counts."""
    lag_ms: float
    """Lag: 0.1 to 500 ms."""
    resistance_mm2k_w: float
    """Resistance: 0 to 1000 mm2 K/W."""
    w_m2: float | None
    """Flux out of the finger in the last tick, W/m²; unknown if the sensor's code cannot be right."""
    finger: FingerKnowledge
    """What is known of the finger."""

    @classmethod
    def read(cls, reply: Fields) -> FluxReport | None:
        if reply.value("flux", str) == "none":
            return None
        return cls(
            counts_per_w_m2=reply.value("counts_per_w_m2", real),
            zero_counts=reply.value("zero_counts", real),
            lag_ms=reply.value("lag_ms", real),
            resistance_mm2k_w=reply.value("resistance_mm2k_w", real),
            w_m2=reply.or_none("w_m2", real),
            finger=cast(FingerKnowledge, reply.value("finger", str)),
        )
    # /generated


@dataclass(frozen=True)
class PersonReport:
    """Answer to `person` and `person enrol`: who touches, and what is known of the finger."""

    # generated: PersonReport
    code: str | None
    """Code of the chosen or enrolled person, or none for an unknown one."""
    contacts: int
    """Contacts of 8 s or more, trusted to their end, since learning began or was last distrusted."""
    data: str | None
    """What is stored of the finger, 40 hexadecimal digits; none of an unknown person."""

    @classmethod
    def read(cls, reply: Fields) -> PersonReport:
        return cls(
            code=reply.or_none("person", str, "none"),
            contacts=reply.value("contacts", int),
            data=reply.if_reported("data", str),
        )
    # /generated


@dataclass(frozen=True)
class DisplaySurface:
    """Answer to `surface`: the surface of the display."""

    # generated: SurfaceReport
    conductivity_w_mk: float
    """Conductivity: 0.1 to 500 W/mK."""
    roughness_um: float
    """Roughness: 0.01 to 30 um."""
    slope_rad: float
    """Slope: 0.001 to 1.5 rad."""

    @classmethod
    def read(cls, reply: Fields) -> DisplaySurface:
        return cls(
            conductivity_w_mk=reply.value("conductivity_w_mk", real),
            roughness_um=reply.value("roughness_um", real),
            slope_rad=reply.value("slope_rad", real),
        )
    # /generated


SIMULATED_UID = "53494D55"
"""First word of the unique identifier of a simulated microcontroller: a real one has its place on the wafer there."""


@dataclass(frozen=True)
class BoardReport:
    """Answer to `board`."""

    # generated: BoardReport
    bor: int
    """Brown-out level of the option bytes, 0 (off, as delivered) to 3; other than 3 trips."""
    watchdogs: str
    """Whether watchdogs run, or a debugger can halt them."""
    clock: str
    """Source of the clocks: external, or the internal oscillator while the device waits for the external one."""
    pwm_lock: int
    """Level of the lock of the PWM timers' settings, 0 (off) to 3; other than 3 trips."""
    reset: str
    """Cause of the last reset."""
    rx_overruns: int
    """Received bytes that were lost because they were fetched too late."""
    rx_framing: int
    """Received bytes without a valid stop bit."""
    rx_noise: int
    """Received bytes with noise."""
    tx_dropped: int
    """Lines of telemetry that were dropped because the line to the host was too slow."""
    uid: str | None
    """Unique identifier of the microcontroller, 24 hexadecimal digits."""
    program: str | None
    """Digest of the program in its flash, which tells one build from another, eight hexadecimal digits; none of a simulated device without a flash."""

    @classmethod
    def read(cls, reply: Fields) -> BoardReport:
        return cls(
            bor=reply.value("bor", int),
            watchdogs=reply.value("watchdogs", str),
            clock=reply.value("clock", str),
            pwm_lock=reply.value("pwm_lock", int),
            reset=reply.value("reset", str),
            rx_overruns=reply.value("rx_overruns", int),
            rx_framing=reply.value("rx_framing", int),
            rx_noise=reply.value("rx_noise", int),
            tx_dropped=reply.value("tx_dropped", int),
            uid=reply.if_reported("uid", str),
            program=reply.if_reported("program", str),
        )
    # /generated

    @property
    def simulated(self) -> bool:
        """Whether the microcontroller is a simulated one, as its identifier says, whatever line leads to it."""
        return self.uid is not None and self.uid.startswith(SIMULATED_UID)


@dataclass(frozen=True)
class CalibrationFit:
    """Answer to a calibration point."""

    # generated: CalibrationFit
    points: int
    """Points of this thermistor so far."""
    worst_mk: float
    """Largest difference between device and reference at these points, mK."""

    @classmethod
    def read(cls, reply: Fields) -> CalibrationFit:
        return cls(
            points=reply.value("points", int),
            worst_mk=reply.value("worst_mk", real),
        )
    # /generated


@dataclass(frozen=True)
class IdentifiedTile:
    """Answer to `margins` and `tune result`."""

    # generated: IdentifiedTile
    gain_k_s_a: float
    """Rate of change of the plate per demanded current, K/s per A."""
    joule_per_a: float
    """Relative loss of this gain by Joule heat, 1/A."""
    leak_1_s: float
    """Rate at which the plate relaxes, 1/s."""
    lag_s: float
    """Lag of the display's thermistor, s."""
    dead_s: float
    """Dead time from the demanded current to the surface of the plate, s."""
    phase_deg: float
    """Phase margin, degrees."""
    gain_margin: float
    """Gain margin, as a factor."""

    @classmethod
    def read(cls, reply: Fields) -> IdentifiedTile:
        return cls(
            gain_k_s_a=reply.value("gain", real),
            joule_per_a=reply.value("joule", real),
            leak_1_s=reply.value("leak", real),
            lag_s=reply.value("lag_s", real),
            dead_s=reply.value("dead_s", real),
            phase_deg=reply.value("phase_deg", real),
            gain_margin=reply.value("margin", real),
        )
    # /generated
