"""Events that the device reports."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .errors import EventTimeout
from .words import EventKind

if TYPE_CHECKING:
    from .connection import Connection

EVENTS_KEPT_MAX = 10_000
"""Events that are kept until they are taken; then the oldest is dropped."""


@dataclass(frozen=True)
class Event:
    """An event of the device."""

    kind: EventKind
    tick: int
    """Tick in which it happened, ms since reset."""
    microseconds: int
    """From the start of the tick to the edge at the trigger input; 0 for other kinds."""
    finger: int
    """The finger; 0 on a device with one."""
    host_s: float
    """When it happened, s of `time.perf_counter()`, estimated."""
    received_s: float
    """When its line arrived, s of `time.perf_counter()`."""


@dataclass(frozen=True)
class Trip:
    """A finger has tripped, as its telemetry says."""

    finger: int
    fault: str
    tick: int
    """Tick of the first telemetry that says so, ms since reset."""
    host_s: float
    """When that tick happened, s of `time.perf_counter()`, estimated."""


def parse_event(content: str) -> tuple[int, int, EventKind] | None:
    """Tick, microseconds and kind of a line without finger and checksum; `None` if it is no event."""
    words = content.split(" ")
    if len(words) != 4 or words[0] != "E":
        return None
    try:
        return int(words[1]), int(words[2]), EventKind(words[3])
    except ValueError:
        return None


class EventLog:
    """Events that were received and not taken yet."""

    def __init__(self) -> None:
        self._events: deque[Event] = deque(maxlen=EVENTS_KEPT_MAX)
        self.changed = threading.Condition()

    def put(self, event: Event) -> None:
        """Appends an event."""
        with self.changed:
            self._events.append(event)
            self.changed.notify_all()

    def take(self) -> list[Event]:
        """All events that were not taken yet, oldest first."""
        with self.changed:
            events = list(self._events)
            self._events.clear()
            return events

    def take_first(self, kind: EventKind | None, finger: int | None) -> Event | None:
        """The oldest event of a kind and finger; the others stay."""
        for event in self._events:
            if (kind is None or event.kind == kind) and (finger is None or event.finger == finger):
                self._events.remove(event)
                return event
        return None


class Events:
    """Events of a device. All functions may be called from any thread."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._log = connection.events

    def take(self) -> list[Event]:
        """All events since they were last taken, oldest first; does not wait."""
        return self._log.take()

    def clear(self) -> None:
        """Forgets the events so far, so that `wait` waits for a new one."""
        self._log.take()

    def wait(
        self,
        kind: EventKind | str | None = None,
        timeout_s: float = 5.0,
        finger: int | None = None,
    ) -> Event:
        """Waits for an event of a kind (or any) and takes it; other events stay. One that has come before and was not taken is
        returned at once.

        Raises `EventTimeout` after `timeout_s`, and `DeviceTripped` if telemetry says that the device has tripped.
        """
        wanted = None if kind is None else EventKind(kind)
        end_s = time.perf_counter() + timeout_s
        while True:
            with self._log.changed:
                event = self._log.take_first(wanted, finger)
                if event is not None:
                    return event
                rest_s = end_s - time.perf_counter()
                if rest_s > 0:
                    self._log.changed.wait(min(rest_s, 0.1))
            self._connection.raise_if_unusable()
            self._connection.raise_if_tripped(finger, "the event does not come")
            if rest_s <= 0:
                what = "event" if wanted is None else f"event '{wanted}'"
                reported = "" if self._connection.events_reported else "; events are off"
                raise EventTimeout(f"no {what} within {timeout_s:g} s{reported}")

    def subscribe(
        self, callback: Callable[[Event], None], kind: EventKind | str | None = None
    ) -> Callable[[], None]:
        """Calls `callback` for each event of a kind (or any), in a thread of its own, in which commands are allowed; returns a
        function that ends this. Events are kept for `wait` and `take` all the same."""
        wanted = None if kind is None else EventKind(kind)

        def on_event(event: Event) -> None:
            if wanted is None or event.kind == wanted:
                callback(event)

        return self._connection.callbacks.subscribe(Event, on_event)
