"""The display as a program sees it."""

from __future__ import annotations

import logging
import os
import threading
import weakref
from collections.abc import Callable, Iterable
from types import TracebackType
from typing import Literal

from .commands import Commands
from .connection import Connection
from .device_clock import DeviceClock
from .errors import BridgeNotOff, DisplayError
from .events import Events, Trip
from .link import Link, SerialLink, TcpLink
from .replies import BoardReport, Identity
from .simulator import Simulator, Speed
from .telemetry import LineCounts, Stream, Telemetry
from .words import TELEMETRY_FIELDS, TelemetryField

log = logging.getLogger("thermal_display")

ANSWER_TIMEOUT_S = 2.0
STREAM_MS = 10
"""Interval of telemetry unless another one is chosen, ms."""
BUFFER_ROWS = 65_536
"""Rows of telemetry that are kept until they are taken: a minute at 1 kHz."""


class Finger(Commands):
    """One finger of a device, from `Display.finger`."""

    def __init__(self, display: Display, finger: int) -> None:
        # The display lives as long as its fingers do: when it is collected, the bridge is switched off.
        self._display = display
        self._connection = display._connection
        self._finger = finger

    @property
    def number(self) -> int:
        """Its number, from 0 on."""
        assert self._finger is not None
        return self._finger

    def __repr__(self) -> str:
        return f"<finger {self._finger} of {self._display!r}>"


class Display(Commands):
    """A thermal display. Open it by `open`, `tcp` or `simulated`, as a context manager:

        with Display.open("/dev/ttyACM0") as display:
            display.arm(wait_s=5)
            display.hold(30.0)

    However the block ends, the bridge is switched off and that is confirmed; `BridgeNotOff` says if it could not be. The same
    happens at `close`, when the display is forgotten, and when Python ends. A process that is killed cannot do that: then the
    device trips by `host-silent` within 2 s, provided that telemetry streams, as it does unless it was switched off.

    All commands may be called from any thread. A thread of its own reads the line and sends a sign of life twice a second; it shows
    that the process lives, not that the script makes progress.
    """

    def __init__(
        self,
        link: Link,
        *,
        checksums: bool = True,
        stream_ms: int = STREAM_MS,
        fields: Iterable[TelemetryField] = TELEMETRY_FIELDS,
        events: bool = True,
        timeout_s: float = ANSWER_TIMEOUT_S,
        buffer_rows: int = BUFFER_ROWS,
        simulator: Simulator | None = None,
        real_time: bool = True,
    ) -> None:
        self._finger = None
        self._connection = Connection(
            link, timeout_s=timeout_s, buffer_rows=buffer_rows, real_time=real_time
        )
        self.simulator = simulator
        """The simulated device, of `Display.simulated`."""
        stream = Stream.of(stream_ms, fields)
        try:
            self.identity: Identity = self._connection.attach(
                checksums=checksums, stream=stream, events=events
            )
            """Name, version, fingers and capabilities of the device."""
        except BaseException:
            self._connection.release()
            raise
        self.telemetry = Telemetry(self._connection)
        self.events = Events(self._connection)
        self._finalizer = weakref.finalize(self, _forgotten, self._connection, simulator)

    @classmethod
    def open(
        cls,
        port: str,
        *,
        checksums: bool = True,
        stream_ms: int = STREAM_MS,
        fields: Iterable[TelemetryField] = TELEMETRY_FIELDS,
        events: bool = True,
        timeout_s: float = ANSWER_TIMEOUT_S,
        buffer_rows: int = BUFFER_ROWS,
    ) -> Display:
        """The device at a serial port, such as `/dev/ttyACM0` or `COM5`, for this program alone. `stream_ms` is the interval of
        telemetry, ms; `timeout_s` how long an answer may take, s."""
        return cls(
            SerialLink(port),
            checksums=checksums,
            stream_ms=stream_ms,
            fields=fields,
            events=events,
            timeout_s=timeout_s,
            buffer_rows=buffer_rows,
        )

    @classmethod
    def tcp(
        cls,
        address: str,
        *,
        checksums: bool = True,
        stream_ms: int = STREAM_MS,
        fields: Iterable[TelemetryField] = TELEMETRY_FIELDS,
        events: bool = True,
        timeout_s: float = ANSWER_TIMEOUT_S,
        buffer_rows: int = BUFFER_ROWS,
    ) -> Display:
        """The device at HOST:PORT, such as one of `hil-sim serve --tcp 127.0.0.1:4000`; the rest as in `open`."""
        return cls(
            TcpLink(address),
            checksums=checksums,
            stream_ms=stream_ms,
            fields=fields,
            events=events,
            timeout_s=timeout_s,
            buffer_rows=buffer_rows,
        )

    @classmethod
    def simulated(
        cls,
        hil_sim: str | os.PathLike[str] | None = None,
        scene: str | os.PathLike[str] | None = None,
        fingers: Literal[1, 5] = 1,
        speed: Speed = "1",
        *,
        surroundings: bool = False,
        commissioned: bool = True,
        checksums: bool = True,
        stream_ms: int | None = None,
        fields: Iterable[TelemetryField] = TELEMETRY_FIELDS,
        events: bool = True,
        timeout_s: float = ANSWER_TIMEOUT_S,
        buffer_rows: int = BUFFER_ROWS,
    ) -> Display:
        """A simulated device, which ends with the display. `hil_sim` is the path of the program, else the environment variable
        THERMAL_DISPLAY_HIL_SIM or the search path says it.

        A scene brings fingers that land (its time zero is 8 s after power-up). With `surroundings`, for one finger,
        `display.simulator.press(2.0)` presses with 2 N instead. At `speed="max"` the device's time passes as fast as it goes: a
        driven display would trip by `host-silent` between two keep-alive lines, so telemetry is off there unless `stream_ms`
        says otherwise, and with it the guard. The device is calibrated and tuned; `commissioned=False` gives one as it leaves the
        factory, which is slow and has a small range.
        """
        simulator = Simulator(hil_sim, scene, fingers, speed, surroundings, commissioned)
        if stream_ms is None:
            stream_ms = 0 if speed == "max" else STREAM_MS
        try:
            return cls(
                TcpLink(simulator.address),
                checksums=checksums,
                stream_ms=stream_ms,
                fields=fields,
                events=events,
                timeout_s=timeout_s,
                buffer_rows=buffer_rows,
                simulator=simulator,
                real_time=speed == "1",
            )
        except BaseException:
            simulator.stop()
            raise

    def __enter__(self) -> Display:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            self.close()
        except BridgeNotOff:
            # It is logged in any case. An interrupt or exit of the program must go on as what it is.
            if error is None or isinstance(error, Exception):
                raise

    def close(self) -> None:
        """Switches the bridge off and confirms it, ends telemetry and events, releases the port, and ends a simulated device.
        May be called twice. Raises `BridgeNotOff`."""
        self._finalizer.detach()
        try:
            self._connection.close()
        finally:
            if self.simulator is not None:
                self.simulator.stop()

    def __repr__(self) -> str:
        state = "closed" if self._connection.closed else "open"
        return f"<Display {self._connection.link.name}, {state}>"

    def finger(self, number: int) -> Finger:
        """A finger of a device with several, from 0 on: its commands are for this finger alone."""
        if not 0 <= number < self.identity.fingers:
            raise ValueError(f"finger {number} is not there; the device has 0 to {self.identity.fingers - 1}")
        if self.identity.fingers == 1:
            raise ValueError("the device has one finger: its commands are those of the display")
        return Finger(self, number)

    @property
    def fingers(self) -> int:
        """Number of fingers of the device."""
        return self.identity.fingers

    @property
    def clock(self) -> DeviceClock:
        """When ticks happened by `time.perf_counter()`."""
        return self._connection.clock

    @property
    def counts(self) -> LineCounts:
        """Lines that were lost, damaged or overwritten since the display was opened."""
        return self._connection.counts

    @property
    def restarts(self) -> int:
        """Restarts of the device that were noticed, without those of `save` and `forget`."""
        return self._connection.restarts

    @property
    def guarded(self) -> bool:
        """Whether the device trips by `host-silent` if this program dies: telemetry of every finger streams."""
        return self._connection.guarded

    @property
    def trip(self) -> Trip | None:
        """The trip that telemetry shows now, of any finger."""
        return self._connection.trip(None)

    def check(self) -> None:
        """Raises `DeviceTripped` if telemetry shows a trip, or what ended the connection. Sends nothing otherwise, so it may be
        called in each frame."""
        self._connection.raise_if_unusable()
        self._connection.raise_if_tripped(None, "it cannot go on")

    def on_trip(self, callback: Callable[[Trip], None]) -> Callable[[], None]:
        """Calls `callback` when telemetry first shows a trip, in a thread of its own, in which commands are allowed; returns a
        function that ends this."""
        return self._connection.callbacks.subscribe(Trip, callback)

    # Commands that are for the whole device

    def id(self) -> Identity:
        """Asks for name, version, fingers and capabilities."""
        return self._connection.ask("id", Identity.read)

    def board(self) -> BoardReport:
        """State of the microcontroller and of the line."""
        return self._connection.ask("board", BoardReport.read)

    def checksums(self, on: bool) -> None:
        """Checksums on all lines from now on, or on none."""
        self._connection.set_checksums(on)

    def events_on(self, on: bool = True) -> None:
        """Events are reported from now on, or not."""
        self._tell("events on" if on else "events off")

    def save(self) -> None:
        """Restarts the device and stores its settings. Material, object, course and mode must be set again; checksums,
        telemetry and events are switched on again."""
        self._connection.store("save")

    def forget(self) -> None:
        """As `save`, but stores the class values (factory settings)."""
        self._connection.store("forget")


def _forgotten(connection: Connection, simulator: Simulator | None) -> None:
    """Ends what a display has begun that nobody closed."""
    log.warning("%s was not closed: its bridge is switched off now", connection.link.name)
    if connection.reads_here:
        # Garbage is collected in whichever thread happens to run.
        threading.Thread(target=_end, args=(connection, simulator)).start()
    else:
        _end(connection, simulator)


def _end(connection: Connection, simulator: Simulator | None) -> None:
    try:
        connection.close()
    except DisplayError:
        # `close` has logged it.
        pass
    finally:
        if simulator is not None:
            simulator.stop()
