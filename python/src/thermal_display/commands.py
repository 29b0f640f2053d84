"""The commands of the protocol, for all fingers of a device or for one."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from typing import cast

import numpy as np
import numpy.typing as npt

from . import wire
from .connection import Connection
from .errors import DeviceTripped, LineDamaged, StateTimeout
from .replies import (
    CalibrationFit,
    Cause,
    ContactLaw,
    DisplaySurface,
    Fields,
    FluxReport,
    IdentifiedTile,
    PersonReport,
    RawReadings,
    SelfTestReport,
    Status,
)
from .telemetry import Stream
from .words import (
    ALL_FIELDS,
    TELEMETRY_FIELDS,
    AssumedFinger,
    ContactMode,
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

STATE_POLL_S = 0.02
"""Interval of the questions of `wait_state`, s."""
UPLOAD_ATTEMPTS = 3
"""Number of times an upload is begun anew after a damaged line."""


def _play_words(start: PlayStart, repeats: int, end: PlayEnd) -> str:
    return f"{start} {int(repeats)} {end}"


class Commands:
    """Commands that address all fingers of a device, or one. Each returns when the device has answered, and raises
    `Refused` with the device's reason, `DeviceTripped`, `NoAnswer` or `LineBroken` otherwise. Which state allows which
    command is listed in docs/protocol.md of the device's repository."""

    _connection: Connection
    _finger: int | None

    def query(self, line: str) -> str:
        """Sends any line of the protocol, without address and checksum, and returns its answer, `ok …` or `err …`. Use
        `stream` and `events_on` for what they do: this end must know it."""
        address = "" if self._finger is None else f"@{self._finger} "
        return self._connection.query(address + line)

    def _tell(self, line: str) -> None:
        self._connection.tell(line, self._finger)

    # Questions

    def state(self) -> Status:
        """State, object and set-point. Without a finger it is that of finger 0."""
        return self._connection.ask("state", Status.read, self._finger)

    def cause(self) -> Cause | None:
        """Why the device tripped, now or the last time."""
        return self._connection.ask("cause", Cause.read, self._finger)

    def self_test(self) -> SelfTestReport:
        """What the last self-test measured."""
        return self._connection.ask("self-test", SelfTestReport.read, self._finger)

    def raw(self) -> RawReadings:
        """The converter's counts in the last tick."""
        return self._connection.ask("raw", RawReadings.read, self._finger)

    def margins(self) -> IdentifiedTile:
        """The tile in use, and the stability margins of its loop."""
        return self._connection.ask("margins", IdentifiedTile.read, self._finger)

    def flux(self) -> FluxReport | None:
        """The heat-flux sensor, its flux, and what is known of the finger by it; `None` without one."""
        return self._connection.ask("flux", FluxReport.read, self._finger)

    def contact_law(self) -> ContactLaw:
        """The contact law that is taken for the finger's."""
        return self._connection.ask("contact", ContactLaw.read, self._finger)

    def person(self) -> PersonReport:
        """The chosen person, and from how many long contacts the finger is learnt. Refused without a heat-flux sensor."""
        return self._connection.ask("person", PersonReport.read, self._finger)

    def persons(self) -> list[str]:
        """The codes of all stored persons."""

        def codes(reply: Fields) -> list[str]:
            text = reply.value("persons", str)
            return [] if text == "none" else text.split(",")

        return self._connection.ask("persons", codes)

    def surface(self) -> DisplaySurface:
        """The surface of the display."""
        return self._connection.ask("surface", DisplaySurface.read, self._finger)

    # The object

    def material(self, name: Material) -> None:
        """Chooses the object's material, which ends a slab or an upload."""
        self._tell(f"material {name}")

    def material_custom(
        self,
        conductivity_w_mk: float,
        density_kg_m3: float,
        specific_heat_j_kgk: float,
        roughness_um: float,
        slope_rad: float,
    ) -> None:
        """Chooses a material by its properties: conductivity, W/(m K); density, kg/m³; specific heat, J/(kg K); RMS roughness,
        µm; mean slope of the asperities, rad."""
        values = [
            wire.number(conductivity_w_mk, "conductivity_w_mk"),
            wire.number(density_kg_m3, "density_kg_m3"),
            wire.number(specific_heat_j_kgk, "specific_heat_j_kgk"),
            wire.number(roughness_um, "roughness_um"),
            wire.number(slope_rad, "slope_rad"),
        ]
        self._tell("material custom " + " ".join(values))

    def object_temperature(self, object_c: float | None) -> None:
        """Temperature of the object before contact, -20 to 60 °C; `None` for that of the room thermistor."""
        self._tell("object room" if object_c is None else f"object {wire.number(object_c, 'object_c')}")

    def object_half_space(self) -> None:
        """The object is an endless block of its material."""
        self._tell("object half-space")

    def object_slab(
        self, thickness_mm: float, back: SlabBack | None = None, film_w_m2k: float | None = None
    ) -> None:
        """The object is a slab of its material, 0.1 to 1000 mm. Behind it no heat passes (`insulated`), the temperature stays
        (`held`), or stays behind a film of `film_w_m2k`, 0.1 to 100000 W/(m² K)."""
        if (back is None) == (film_w_m2k is None):
            raise ValueError("a slab needs either back='insulated' or 'held', or film_w_m2k")
        behind = back if film_w_m2k is None else f"film {wire.number(film_w_m2k, 'film_w_m2k')}"
        self._tell(f"object slab {wire.number(thickness_mm, 'thickness_mm')}mm {behind}")

    def upload_object(
        self, direct_mm2k_w: float, relaxations: Iterable[tuple[float, float]]
    ) -> None:
        """The object is one of this surface impedance: direct term, mm² K/W, and for each relaxation its rate, 1/s, and gain,
        mm² K/J. `hil-sim object SCENE.toml` computes them for layers."""
        rows = [
            f"{wire.number(rate_1_s, 'rate_1_s')} {wire.number(gain_mm2k_j, 'gain_mm2k_j')}"
            for rate_1_s, gain_mm2k_j in relaxations
        ]
        self._upload(f"upload begin object {len(rows)} {wire.number(direct_mm2k_w, 'direct_mm2k_w')}", rows)

    def upload_lines(self, lines: Iterable[str]) -> None:
        """Sends the lines that `hil-sim object SCENE.toml` prints, material and upload, without blank ones."""
        for line in lines:
            if line.strip():
                self._tell(line.strip())

    def upload_course(self, points: npt.ArrayLike, relative: bool = False) -> None:
        """Loads a course: 2 to 128 rows of time, s, and temperature, °C, or with `relative` K above the skin before contact.
        It replaces the one before if all of it is valid; a course that plays is not changed."""
        array = np.asarray(points, dtype=np.float64)
        if array.ndim != 2 or array.shape[1] != 2:
            raise ValueError(f"a course has rows of time, s, and temperature; these have the shape {array.shape}")
        rows = [
            f"{wire.number(t_s, 't_s', 3)} {wire.number(celsius, 'temperature', 6)}" for t_s, celsius in array
        ]
        self._upload(f"upload begin course {len(rows)} {'relative' if relative else 'absolute'}", rows)

    def _upload(self, begin: str, rows: Sequence[str]) -> None:
        lines = [begin, *(f"upload row {index} {row}" for index, row in enumerate(rows))]
        lines.append(wire.upload_commit(lines))
        for attempt in range(UPLOAD_ATTEMPTS):
            try:
                for line in lines:
                    self._tell(line)
                return
            except LineDamaged:
                # Nothing changes before the commit, and `begin` discards what has been sent.
                if attempt + 1 == UPLOAD_ATTEMPTS:
                    raise

    # What is assumed, and how it is controlled

    def assume_finger(self, finger: AssumedFinger) -> None:
        """Chooses the finger that is assumed for the one that touches."""
        self._tell(f"finger {finger}")

    def assumed_finger(self) -> AssumedFinger:
        """The finger that is assumed."""
        return self._connection.ask(
            "finger", lambda reply: cast(AssumedFinger, reply.value("finger", str)), self._finger
        )

    def set_contact_law(self, law: ContactLaw | None) -> None:
        """Takes this contact law for the finger's; `None` for Eq. 6-8, the default. Refused for the finger `thesis`."""
        if law is None:
            self._tell("contact nominal")
            return
        values = [
            wire.number(law.exponent, "exponent"),
            wire.number(law.hardness_pa, "hardness_pa"),
            wire.number(law.gap_w_m2k, "gap_w_m2k"),
        ]
        self._tell("contact " + " ".join(values))

    def skin(self, skin_c: float | None) -> None:
        """Skin before contact that set-points assume, 15 to 42 °C; `None` for that of the sensor."""
        self._tell("skin sensor" if skin_c is None else f"skin {wire.number(skin_c, 'skin_c')}")

    def mode(self, mode: ContactMode) -> None:
        """Set-point with contact resistance, or for perfect contact."""
        self._tell(f"mode {mode}")

    def set_law(self, law: Law) -> None:
        """Chooses the control law."""
        self._tell(f"law {law}")

    def law(self) -> Law:
        """The control law in use."""
        return self._connection.ask("law", lambda reply: cast(Law, reply.value("law", str)), self._finger)

    # Driving

    def arm(self, wait_s: float = 0.0) -> None:
        """Runs the self-test if it has not been passed since the device was off (0.8 s, 1.8 s under a finger), then drives the
        display to skin temperature. Waits at most `wait_s` for the state `armed`, or not at all; the display then begins to move
        there, and `telemetry.wait_for` tells when it has come."""
        self._tell("arm")
        if wait_s > 0:
            self.wait_state(State.ARMED, timeout_s=wait_s)

    def start(self) -> None:
        """The object appears: `preset`, then `contact` whenever a finger lands."""
        self._tell("start")

    def abort(self) -> None:
        """Bridge off, at once: also while another thread waits for an answer, which then raises `Interrupted`."""
        self._connection.abort(self._finger)

    def clear(self) -> None:
        """Clears a latched fault that is no longer present."""
        self._tell("clear")

    def hold(self, setpoint_c: float, rate_k_s: float | None = None) -> None:
        """Moves the set-point to 15 to 42 °C, at 1 K/s or at `rate_k_s`, 0.01 to 100 K/s, and holds it there."""
        rate = "" if rate_k_s is None else " " + wire.number(rate_k_s, "rate_k_s")
        self._tell(f"hold {wire.number(setpoint_c, 'setpoint_c')}{rate}")

    def play(self, start: PlayStart = "now", repeats: int = 1, end: PlayEnd = "hold") -> None:
        """Plays the loaded course 1 to 1000 times. With events on, `start` and `end` say when it begins and has ended."""
        self._tell(f"play {_play_words(start, repeats, end)}")

    def pulse(
        self,
        base_c: float,
        target_c: float,
        rise_k_s: float,
        hold_s: float,
        return_k_s: float,
        start: PlayStart = "now",
        repeats: int = 1,
        end: PlayEnd = "hold",
    ) -> None:
        """Loads and plays a pulse: from `base_c` to `target_c`, °C, at `rise_k_s`, K/s; there for `hold_s`, s; back at
        `return_k_s`, K/s."""
        values = [
            wire.number(base_c, "base_c"),
            wire.number(target_c, "target_c"),
            wire.number(rise_k_s, "rise_k_s"),
            wire.number(hold_s, "hold_s"),
            wire.number(return_k_s, "return_k_s"),
        ]
        self._tell(f"pulse {' '.join(values)} {_play_words(start, repeats, end)}")

    def wait_state(self, *states: State | str, timeout_s: float = 5.0) -> None:
        """Waits until the finger, or every finger of the device, is in one of these states.

        Raises `StateTimeout`, and `DeviceTripped` if a finger trips instead.
        """
        wanted = [State(state) for state in states]
        asked = self._finger
        fingers: list[int | None] = (
            [asked] if asked is not None or self._connection.fingers == 1 else [*range(self._connection.fingers)]
        )
        end_s = time.perf_counter() + timeout_s
        for finger in fingers:
            while True:
                status = self._connection.ask("state", Status.read, finger)
                if status.state in wanted:
                    break
                if status.fault is not None:
                    cause = self._connection.ask("cause", Cause.read, finger)
                    raise DeviceTripped(status.fault, finger, cause, f"it does not become {' or '.join(wanted)}")
                if time.perf_counter() >= end_s:
                    where = "" if finger is None else f"finger {finger}: "
                    raise StateTimeout(
                        f"{where}the state is still '{status.state}' after {timeout_s:g} s, "
                        f"instead of {' or '.join(wanted)}"
                    )
                time.sleep(STATE_POLL_S)

    # Telemetry, events, triggers

    def stream(self, interval_ms: int, fields: Iterable[TelemetryField] = TELEMETRY_FIELDS) -> None:
        """Telemetry every 1 to 60000 ms, with these fields; the columns of the others are NaN. The serial line carries some
        1000 lines a second, of all fingers together. 0 ends telemetry, and with it the device's guard: it does not trip any
        more when this program dies. 60000 keeps the guard."""
        chosen = set(fields)
        unknown = chosen.difference(ALL_FIELDS)
        if unknown:
            raise ValueError(f"unknown fields {', '.join(sorted(unknown))}; known: {', '.join(ALL_FIELDS)}")
        if int(interval_ms) != interval_ms:
            raise ValueError(f"interval_ms is {interval_ms}; allowed are whole numbers from 0 to 60000")
        self._connection.set_stream(self._finger, Stream.of(int(interval_ms), chosen))

    def trigger_out(self, *kinds: TriggerEvent) -> None:
        """The events that give a pulse at the trigger output; without any, none does."""
        self._tell(f"trigger-out {','.join(kinds) or 'none'}")

    def set_trigger_pulse(self, pulse_ms: int) -> None:
        """Length of each pulse at the trigger output from now on, 1 to 200 ms. It is 10 ms after a restart."""
        self._tell(f"trigger-out pulse {int(pulse_ms)}")

    def trigger_pulse(self) -> int:
        """Length of a pulse at the trigger output, ms."""
        return self._connection.ask("trigger-out pulse", lambda reply: reply.value("pulse_ms", int), self._finger)

    # Commissioning

    def tune(self) -> None:
        """Begins to identify the tile; ends a `hold`. No finger may touch the display."""
        self._tell("tune")

    def tune_result(self) -> IdentifiedTile:
        """Result of the identification; raises `Refused` while it goes on."""
        return self._connection.ask("tune result", IdentifiedTile.read, self._finger)

    def calibrate(self, thermistor: Thermistor, reference_c: float) -> CalibrationFit:
        """Takes a point: what the reference thermometer shows at a thermistor, °C."""
        line = f"calibrate {thermistor} {wire.number(reference_c, 'reference_c', 3)}"
        return self._connection.ask(line, CalibrationFit.read, self._finger)

    def calibrate_clear(self, thermistor: Thermistor) -> None:
        """Deletes points and correction of a thermistor."""
        self._tell(f"calibrate {thermistor} clear")

    def set_flux_sensor(
        self, counts_per_w_m2: float, zero_counts: float, lag_ms: float, resistance_mm2k_w: float
    ) -> None:
        """The display has this heat-flux sensor: gain, 0.01 to 1 counts of 4096 per W/m²; code without flux, 64 to 4031; time
        constant, 0.1 to 500 ms; thermal resistance, 0 to 1000 mm² K/W. `save` stores it."""
        values = [
            wire.number(counts_per_w_m2, "counts_per_w_m2"),
            wire.number(zero_counts, "zero_counts"),
            wire.number(lag_ms, "lag_ms"),
            wire.number(resistance_mm2k_w, "resistance_mm2k_w"),
        ]
        self._tell("flux set " + " ".join(values))

    def remove_flux_sensor(self) -> None:
        """The display has no heat-flux sensor."""
        self._tell("flux none")

    def take_flux_zero(self) -> None:
        """Takes the mean code of the last half second as the zero of the heat-flux sensor. No finger may touch the display, which
        must have the temperature of the room."""
        self._tell("flux zero")

    def choose_person(self, code: str | None) -> None:
        """This stored person touches, or an unknown one. Learning begins anew."""
        self._tell(f"person {'none' if code is None else code}")

    def store_person(self, code: str, data: str) -> None:
        """Stores a person; `data` as `enrol_person` returns it. `save` keeps it in flash."""
        self._connection.tell(f"person {code} {data}")

    def enrol_person(self, code: str) -> PersonReport:
        """Stores what was learnt of the finger as that of a person. Refused before two contacts of 8 s that are trusted."""
        return self._connection.ask(f"person enrol {code}", PersonReport.read, self._finger)

    def forget_person(self, code: str) -> None:
        """Forgets a person; in flash after `save`."""
        self._connection.tell(f"forget person {code}")

    def set_surface(self, conductivity_w_mk: float, roughness_um: float, slope_rad: float) -> None:
        """The display has this surface: conductivity, 0.1 to 500 W/(m K); RMS roughness, 0.01 to 30 µm; mean slope, 0.001 to 1.5 rad.
        `save` stores it."""
        values = [
            wire.number(conductivity_w_mk, "conductivity_w_mk"),
            wire.number(roughness_um, "roughness_um"),
            wire.number(slope_rad, "slope_rad"),
        ]
        self._tell("surface set " + " ".join(values))

    def set_nominal_surface(self) -> None:
        """The display has the surface of the reference design."""
        self._tell("surface nominal")

    def settings(self) -> list[str]:
        """The settings as lines `set …`, which `set_settings` takes."""

        def count(reply: Fields) -> int:
            return reply.value("lines", int)

        def text(reply: Fields) -> str:
            if not reply.text.startswith("set "):
                raise ValueError("no line of settings")
            return reply.text

        lines = self._connection.ask("settings", count, self._finger)
        return [self._connection.ask(f"settings {n}", text, self._finger) for n in range(1, lines + 1)]

    def set_settings(self, lines: Iterable[str]) -> None:
        """Replaces settings by lines of `settings`; `save` stores them."""
        for line in lines:
            if not line.startswith("set "):
                raise ValueError(f"'{line}' is no line of settings; they begin with 'set '")
            self._tell(line)
