"""Telemetry: lines, the buffer that they go to, and how many were lost."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from .errors import TelemetryTimeout
from .words import ALL_FIELDS, TELEMETRY_FIELDS, State, TelemetryField

if TYPE_CHECKING:
    from .connection import Connection


@dataclass(frozen=True)
class Column:
    """A field of a telemetry line as the column of an array."""

    field: TelemetryField
    name: str
    kind: Literal["number", "count", "word"]


COLUMNS: tuple[Column, ...] = (
    # generated: telemetry-columns
    Column("setpoint", "setpoint_c", "number"),
    Column("display", "display_c", "number"),
    Column("sink", "sink_c", "number"),
    Column("skin", "skin_c", "number"),
    Column("room", "room_c", "number"),
    Column("force", "force_n", "number"),
    Column("demand", "demand_a", "number"),
    Column("current", "current_a", "number"),
    Column("evaluations", "evaluations", "count"),
    Column("flux", "flux_w_m2", "number"),
    Column("surface", "surface_c", "number"),
    Column("finger", "known", "word"),
    Column("check", "check_c", "number"),
    # /generated
)
"""The fields in the order of a line."""

_READERS: dict[str, Callable[[str], Any]] = {"number": float, "count": int, "word": str}
_UNKNOWN: dict[str, Any] = {"number": float("nan"), "count": -1, "word": ""}
_TYPES: dict[str, Any] = {"number": np.float64, "count": np.int64, "word": "U12"}
_OF_EVERY_LINE = COLUMNS[: len(TELEMETRY_FIELDS)]
_NAMED = COLUMNS[len(TELEMETRY_FIELDS) :]

TELEMETRY_DTYPE: np.dtype[Any] = np.dtype(
    [
        ("tick", np.uint32),
        ("finger", np.uint8),
        ("state", "U9"),
        *((column.name, _TYPES[column.kind]) for column in _OF_EVERY_LINE),
        ("remark", "U18"),
        ("host_s", np.float64),
        ("received_s", np.float64),
        ("lost_before", np.uint32),
        *((column.name, _TYPES[column.kind]) for column in _NAMED),
    ]
)
"""Rows of telemetry. `tick` in ms since the device's reset; temperatures in °C, force in N, currents in A; NaN, and -1 for
`evaluations`, is what the device does not know or was not asked for. `host_s` is when the tick happened and `received_s` when the
line arrived, both s of `time.perf_counter()`. `lost_before` lines are missing before this one. The fields that a line has only if
they are named come last, first what the heat-flux sensor shows: flux out of the skin, W/m², estimate of the display's surface, and
what is known of the finger, a word that is empty if it was not asked for or there is no sensor."""

TelemetryArray = np.ndarray[Any, np.dtype[np.void]]
"""One-dimensional structured array of `TELEMETRY_DTYPE`."""

_COLUMN = {column.field: column for column in COLUMNS}
_STATES = frozenset(state.value for state in State)


@dataclass(frozen=True)
class Sample:
    """One row of telemetry; see `TELEMETRY_DTYPE`."""

    tick: int
    finger: int
    state: State
    # generated: telemetry-of-every-line
    setpoint_c: float
    display_c: float
    sink_c: float
    skin_c: float
    room_c: float
    force_n: float
    demand_a: float
    current_a: float
    evaluations: int
    # /generated
    remark: str
    host_s: float
    received_s: float
    lost_before: int
    # generated: telemetry-named
    flux_w_m2: float
    surface_c: float
    known: str
    check_c: float
    # /generated

    @property
    def fault(self) -> str | None:
        """The fault by which the device is tripped."""
        return self.remark if self.state is State.TRIPPED else None

    @property
    def limited(self) -> bool:
        """Whether the set-point is limited."""
        return self.remark == "limited"

    @property
    def untuned(self) -> bool:
        """Whether the line says that the tile was never identified; a line that says `limited` does not tell."""
        return self.remark == "untuned"


@dataclass(frozen=True)
class Stream:
    """What a finger streams."""

    interval_ms: int
    """0 if it does not stream."""
    fields: tuple[TelemetryField, ...]
    """In the order of a line."""

    @classmethod
    def of(cls, interval_ms: int, names: Iterable[str]) -> Stream:
        """With these fields, or with those of `TELEMETRY_FIELDS` if there are none."""
        chosen = set(names)
        return cls(interval_ms, tuple(name for name in ALL_FIELDS if name in chosen) or TELEMETRY_FIELDS)


@dataclass(frozen=True)
class LineCounts:
    """Lines that were not received as they were sent."""

    lost: int = 0
    """Telemetry lines that never came, by their ticks."""
    damaged: int = 0
    """Lines with a wrong checksum, or that are neither telemetry nor event nor answer."""
    overwritten: int = 0
    """Telemetry lines that came and were not taken before the buffer was full."""


@dataclass(frozen=True)
class ParsedLine:
    """A line without its finger and times."""

    tick: int
    state: str
    values: tuple[Any, ...]
    """Of the fields that a line has if none is chosen, in its order."""
    remark: str
    named: tuple[Any, ...]
    """Of the other fields."""


def parse_line(content: str, fields: tuple[TelemetryField, ...]) -> ParsedLine | None:
    """A line without finger and checksum; `None` if it is no telemetry with these fields."""
    words = content.split(" ")
    count = len(fields)
    # A line for which no fields are chosen may have more words from a later firmware.
    if len(words) < count + 4 or (fields != TELEMETRY_FIELDS and len(words) != count + 4):
        return None
    if words[0] != "T" or words[2] not in _STATES:
        return None
    values = {column.field: _UNKNOWN[column.kind] for column in COLUMNS}
    try:
        tick = int(words[1])
        for column, word in zip((_COLUMN[field] for field in fields), words[3:]):
            if word != "-":
                values[column.field] = _READERS[column.kind](word)
    except ValueError:
        return None
    if not 0 <= tick < 1 << 32:
        return None
    return ParsedLine(
        tick=tick,
        state=words[2],
        values=tuple(values[column.field] for column in _OF_EVERY_LINE),
        remark=words[3 + count],
        named=tuple(values[column.field] for column in _NAMED),
    )


class TelemetryBuffer:
    """Ring of rows: filled by the thread that reads the line, emptied by the user's."""

    def __init__(self, rows: int) -> None:
        self._rows: TelemetryArray = np.zeros(rows, dtype=TELEMETRY_DTYPE)
        self._written = 0
        self._taken = 0
        self._overwritten = 0
        self._latest: dict[int, tuple[Any, ...]] = {}
        self._last_finger = 0
        self.changed = threading.Condition()

    def put(self, row: tuple[Any, ...]) -> None:
        """Appends a row; the oldest one that was not taken goes if the buffer is full."""
        with self.changed:
            self._rows[self._written % len(self._rows)] = row
            self._written += 1
            if self._written - self._taken > len(self._rows):
                self._taken += 1
                self._overwritten += 1
            self._last_finger = row[1]
            self._latest[self._last_finger] = row
            self.changed.notify_all()

    def take(self) -> TelemetryArray:
        """All rows that were not taken yet, oldest first."""
        with self.changed:
            size = len(self._rows)
            indices = np.arange(self._taken, self._written) % size
            self._taken = self._written
            taken: TelemetryArray = self._rows[indices]
            return taken

    def latest(self, finger: int | None) -> Sample | None:
        """The last row of a finger, or of any."""
        row = self._latest.get(self._last_finger if finger is None else finger)
        if row is None:
            return None
        tick, of, state, *values = row
        return Sample(tick, of, State(state), *values)

    @property
    def waiting(self) -> int:
        """Rows that were not taken yet."""
        return self._written - self._taken

    @property
    def overwritten(self) -> int:
        """Rows that were not taken in time."""
        return self._overwritten

    def forget_latest(self) -> None:
        """The device has restarted or streams something else: what was the latest row is none any more."""
        with self.changed:
            self._latest.clear()


class Telemetry:
    """Telemetry of a device while it streams. All functions may be called from any thread."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._buffer = connection.telemetry

    def take(self) -> TelemetryArray:
        """All rows since the last `take`, oldest first, as a structured array of `TELEMETRY_DTYPE`; does not wait."""
        return self._buffer.take()

    def latest(self, finger: int | None = None) -> Sample | None:
        """The last row of a finger, or of any; `None` before the first one. Does not wait and takes nothing away."""
        return self._buffer.latest(finger)

    @property
    def waiting(self) -> int:
        """Rows that `take` would return."""
        return self._buffer.waiting

    def wait(self, rows: int = 1, timeout_s: float = 1.0) -> TelemetryArray:
        """Waits until there are at least `rows` rows that were not taken, and takes all.

        Raises `TelemetryTimeout`, and takes nothing, if there are not after `timeout_s`.
        """
        end_s = time.perf_counter() + timeout_s
        with self._buffer.changed:
            while self._buffer.waiting < rows:
                self._connection.raise_if_unusable()
                rest_s = end_s - time.perf_counter()
                if rest_s <= 0:
                    raise TelemetryTimeout(
                        f"{self._buffer.waiting} rows of telemetry within {timeout_s:g} s instead of {rows}; "
                        + self._connection.stream_in_words()
                    )
                self._buffer.changed.wait(min(rest_s, 0.1))
        return self.take()

    def wait_for(
        self,
        condition: Callable[[Sample], bool],
        timeout_s: float = 5.0,
        finger: int | None = None,
    ) -> Sample:
        """Waits for a sample that satisfies a condition, such as `lambda sample: sample.force_n > 0.5`. Takes nothing away.

        Raises `TelemetryTimeout` after `timeout_s`, and `DeviceTripped` if the device trips meanwhile. Between two looks samples
        may pass unseen.
        """
        end_s = time.perf_counter() + timeout_s
        while True:
            # A condition may be for a tripped device, so its row is looked at before the trip is an error.
            trip = self._connection.trip(finger)
            with self._buffer.changed:
                sample = self._buffer.latest(finger)
                if sample is not None and condition(sample):
                    return sample
                rest_s = end_s - time.perf_counter()
                if rest_s > 0 and trip is None:
                    self._buffer.changed.wait(min(rest_s, 0.1))
            self._connection.raise_if_unusable()
            if trip is not None:
                self._connection.raise_if_tripped(finger, "what was waited for does not come")
            if rest_s <= 0:
                raise TelemetryTimeout(
                    f"no telemetry satisfied the condition within {timeout_s:g} s; the last is {sample}; "
                    + self._connection.stream_in_words()
                )
