"""The connection to a device: one line outstanding, checksums, keep-alive, and the thread that reads."""

from __future__ import annotations

import logging
import math
import os
import re
import secrets
import threading
import time
from collections import deque
from collections.abc import Callable
from enum import Enum, auto

from . import wire
from .callbacks import Callbacks
from .device_clock import DeviceClock
from .errors import (
    BridgeNotOff,
    Closed,
    CommandError,
    DeviceBusy,
    DeviceRestarted,
    DeviceTripped,
    DisplayError,
    Interrupted,
    LineBroken,
    LineDamaged,
    NoAnswer,
    NotSendable,
    NotUnderstood,
    Refused,
)
from .events import Event, EventLog, Trip, parse_event
from .link import Link
from .replies import Cause, Fields, Identity, Reply, Status
from .telemetry import LineCounts, Stream, TelemetryBuffer, parse_line
from .words import TELEMETRY_FIELDS

log = logging.getLogger("thermal_display")

KEEP_ALIVE_S = 0.5
"""Longest silence of this end. A device that streams trips after 2 s."""
ATTEMPTS = 3
"""Number of times a line that may be repeated is sent."""
RESTART_TIMEOUT_S = 5.0
"""Timeout of the answer to `save` and `forget`, which comes after the device's restart."""
FIELD_CHANGE_S = 0.02
"""Pause without telemetry between two choices of its fields, so that no line with the old ones comes after the answer to the
second one: the answer overtakes up to eight waiting lines, which take 0.8 ms each."""
SILENT_INTERVALS = 5
SILENT_S = 0.6
"""Telemetry that has not come for so many of its intervals, and for so long at least, s, is missing: the device is asked why."""
OFF_WITHIN_S = 6.0
"""Time in which `close` must have confirmed that the bridge is off, whatever the line does."""
OFF_STREAM = Stream(0, TELEMETRY_FIELDS)

_TRIPPED = re.compile(r"\btripped by ([a-z-]+)")
_NOT_EXECUTED = ("checksum ", "a byte was damaged or lost", "busy; wait for the answer")


class _Kind(Enum):
    """What a line that is neither telemetry nor event is."""

    ANSWER = auto()
    UNCHECKED = auto()
    """An answer without a checksum, although checksums are on: damaged, or of a device that has restarted."""
    DAMAGED = auto()


class _AbortSent(Exception):
    """Another thread has sent `abort`, so the next answers are not those of the line that waits."""


class _Restarted(Exception):
    """The device has forgotten that checksums were on."""


def _is_ok(answer: str) -> bool:
    return wire.split_finger(answer)[1].split(" ", 1)[0] == "ok"



class Connection:
    """A line to a device with the thread that reads it. Holds no reference to the `Display`, so that a forgotten one is
    collected, and the bridge switched off."""

    def __init__(
        self, link: Link, *, timeout_s: float, buffer_rows: int, real_time: bool = True
    ) -> None:
        self.link = link
        self.timeout_s = timeout_s
        self.telemetry = TelemetryBuffer(buffer_rows)
        self.events = EventLog()
        self.callbacks = Callbacks()
        self.clock = DeviceClock(real_time)
        self.fingers = 1
        self.restarts = 0
        self.events_reported = False

        self._pid = os.getpid()
        self._command_lock = threading.Lock()
        # Reentrant: a display that is collected while a line is written switches its bridge off in the same thread.
        self._write_lock = threading.RLock()
        self._answered = threading.Condition()
        self._answers: deque[tuple[_Kind, str]] = deque()
        # The line whose answer comes next; its effect on what follows is noted by the thread that reads.
        self._expected: str | None = None
        self._out_of_step = True
        self._aborts_sent = 0
        # Random, so that no answer to an earlier program has the same word.
        self._synchronization = secrets.randbits(32)
        self._checksums = False
        self._wants_checksums = False

        self._stream_all = OFF_STREAM
        self._stream_own: dict[int, Stream] = {}
        self._last_tick: dict[int, int] = {}
        self._lost = 0
        self._damaged = 0
        self._trips: dict[int, Trip] = {}

        self._broken: str | None = None
        self._busy: str | None = None
        self._closing = False
        self._ended = False
        # Beyond this no answer is waited for.
        self._deadline_s = math.inf
        self._last_sent_s = time.perf_counter()
        # When telemetry was last received, or began to be expected.
        self._heard_s = time.perf_counter()
        self._reader = threading.Thread(
            target=self._read_lines, name=f"thermal-display {link.name}", daemon=True
        )
        self._reader.start()

    # Beginning and end

    def attach(self, *, checksums: bool, stream: Stream, events: bool) -> Identity:
        """Gets in step with a device that may be running, and switches checksums, telemetry and events on."""
        with self._command_lock:
            # Ends a line that another program left unfinished.
            self._transmit("")
            # Whatever an earlier program has left on, the device takes a line with a checksum.
            self._send(wire.with_checksum("checksum off"))
            self._synchronise(self.timeout_s)
        identity = self.ask("id", Identity.read)
        if checksums and identity.can("checksum"):
            self.set_checksums(True)
            # What was said before was not protected, and decides how many fingers are asked and switched off.
            identity = self.ask("id", Identity.read)
        self.fingers = identity.fingers
        self.set_stream(None, stream)
        if identity.can("course"):
            self.tell("events on" if events else "events off")
        self._lost = self._damaged = 0
        return identity

    def close(self) -> None:
        """Switches the bridge off, ends telemetry and events, and releases the port. Whatever happens meanwhile, the port is
        released; raises `BridgeNotOff` if it is not certain within 6 s that the bridge is off, and a `KeyboardInterrupt` that
        came meanwhile."""
        # A child of `os.fork` shares the line, which is not its own to switch off.
        if self._ended or os.getpid() != self._pid:
            return
        self._closing = True
        self._deadline_s = time.perf_counter() + OFF_WITHIN_S
        interrupted: KeyboardInterrupt | None = None
        why = "interrupted"
        try:
            for _ in range(ATTEMPTS):
                try:
                    self._switch_off()
                    why = ""
                    break
                except KeyboardInterrupt as error:
                    interrupted = error
                except DisplayError as error:
                    why = str(error)
                    if self._broken or time.perf_counter() >= self._deadline_s:
                        break
            if not why:
                self._leave_silent()
        except KeyboardInterrupt as error:
            interrupted = error
        finally:
            self._ended = True
            self.callbacks.close()
            self._reader.join(1.0)
            self.link.close()
        if why:
            not_off = BridgeNotOff(why, self.guarded)
            log.critical("%s: %s", self.link.name, not_off)
            if interrupted is not None:
                raise not_off from interrupted
            raise not_off
        if interrupted is not None:
            raise interrupted

    @property
    def reads_here(self) -> bool:
        """Whether this is the thread that reads, in which nobody can wait for an answer."""
        return threading.current_thread() is self._reader

    def release(self) -> None:
        """Releases the port of a device that was not reached."""
        self._closing = self._ended = True
        self._reader.join(1.0)
        self.link.close()

    def _switch_off(self) -> None:
        """Sends `abort` at once, whoever waits for an answer, then confirms that the bridge is off."""
        self._send_abort_at_once("abort")
        if not self._command_lock.acquire(timeout=max(0.0, self._deadline_s - time.perf_counter())):
            raise DisplayError("another thread does not give the line free")
        try:
            self._repeat("abort")
            for answer, status in self._statuses():
                if status.state.is_driven:
                    raise DisplayError(f"after 'abort' the device answers '{answer}'")
        except ValueError as error:
            raise DisplayError(f"the answer to 'state' is not understood: {error}") from error
        finally:
            self._command_lock.release()

    def _leave_silent(self) -> None:
        """Ends telemetry and checksums for the next program, which may be a terminal. The bridge is off: a device that does not
        answer to this harms nobody."""
        with self._command_lock:
            try:
                self._repeat("stream 0")
                if self._checksums:
                    self._wants_checksums = False
                    self._repeat("checksum off")
            except DisplayError as error:
                log.warning("%s: %s", self.link.name, error)

    def _repeat(self, line: str) -> str:
        """Exchanges a line that may be executed twice until it is accepted."""
        failure: DisplayError | None = None
        # An interrupt by another thread's `abort` is no failure of the line.
        for _ in range(2 * ATTEMPTS):
            try:
                answer = self._exchange(line, self.timeout_s)
            except _Restarted:
                # With that its bridge is off; the next answer confirms it.
                self._note_restart()
            except _AbortSent:
                failure = failure or Interrupted(line)
            except CommandError as error:
                if isinstance(failure, type(error)) or time.perf_counter() >= self._deadline_s:
                    raise
                failure = error
            else:
                if _is_ok(answer):
                    return answer
                if not self._is_damage(answer):
                    raise Refused(line, answer, wire.split_finger(answer)[0])
                self._out_of_step = True
                failure = LineDamaged(line, answer, wire.split_finger(answer)[0])
        raise failure or NoAnswer(line, self.timeout_s)

    # Commands

    def ask(
        self,
        line: str,
        read: Callable[[Fields], Reply],
        finger: int | None = None,
        timeout_s: float | None = None,
    ) -> Reply:
        """Sends a line, to one finger or to all, and reads the answer after `ok`."""
        addressed = line if finger is None else f"@{finger} {line}"
        answer = self.query(addressed, timeout_s)
        answered, content = wire.split_finger(answer)
        if content.split(" ", 1)[0] != "ok":
            raise self._refusal(addressed, answer, answered, content)
        try:
            if finger is not None and answered != finger:
                raise ValueError("another finger")
            return read(Fields(content[len("ok") :]))
        except (ValueError, KeyError, IndexError) as error:
            raise NotUnderstood(addressed, answer) from error

    def tell(self, line: str, finger: int | None = None, timeout_s: float | None = None) -> None:
        """Sends a line whose answer is `ok` alone."""

        def nothing(reply: Fields) -> None:
            if reply.text:
                raise ValueError("more than ok")

        self.ask(line, nothing, finger, timeout_s)

    def query(self, line: str, timeout_s: float | None = None) -> str:
        """Sends a line and returns its answer, `ok …` or `err …`, perhaps with the finger before it.

        Questions and the rows of an upload, which have numbers, are sent again if the line or its answer is lost or damaged;
        another line might then be executed twice.
        """
        timeout_s = self.timeout_s if timeout_s is None else timeout_s
        repeatable = wire.may_be_repeated(line)
        with self._command_lock:
            attempt = 0
            while True:
                if self._closing:
                    raise Closed(f"'{line}' is not sent: the display has been closed")
                attempt += 1
                again = repeatable and self._checksums and attempt < ATTEMPTS
                try:
                    answer = self._exchange(line, timeout_s)
                except _AbortSent:
                    if repeatable:
                        continue
                    raise Interrupted(line) from None
                except _Restarted:
                    raise self._restarted(line) from None
                except (NoAnswer, NotUnderstood) as error:
                    if again:
                        continue
                    self._raise_if_restarted(line, error)
                    raise
                if not _is_ok(answer) and self._is_damage(answer):
                    # A byte that became a line end divides a line, which then has two answers.
                    self._out_of_step = True
                    if again:
                        continue
                return answer

    def _raise_if_restarted(self, line: str, error: CommandError) -> None:
        """After a line without an answer: whether that is because the device has restarted."""
        if not self._checksums:
            return
        try:
            self._synchronise(self.timeout_s)
        except _Restarted:
            raise self._restarted(line) from error
        except CommandError:
            # It does not answer at all, as the caller's error says.
            return

    def _restarted(self, line: str) -> DisplayError:
        """The error of a line whose answer shows that the device has forgotten checksums: it has restarted, or, if a bridge is
        on, another program has switched them off. What this end relies on is on again."""
        self._restore_after_restart()
        if wire.split_finger(line)[1] == "arm":
            # The only line by which a device drives after a restart. Material and object are lost, so it must not.
            self._repeat("abort")
        for _, status in self._statuses():
            if status.state.is_driven:
                return DeviceBusy(
                    f"{self.link.name}: checksums were switched off, and the device has not restarted: it is {status.state}, with "
                    "its bridge on. Another program uses the line; let only one be open"
                )
        return DeviceRestarted(line)

    def _statuses(self) -> list[tuple[str, Status]]:
        """The answers to `state` of all fingers, and how they are; raises `ValueError` if one is not understood."""
        # In a device with several fingers a question without address is that of the first one only.
        addresses = [f"@{finger} " for finger in range(self.fingers)] if self.fingers > 1 else [""]
        answers = [self._repeat(f"{address}state") for address in addresses]
        return [
            (answer, Status.read(Fields(wire.split_finger(answer)[1].removeprefix("ok"))))
            for answer in answers
        ]

    @staticmethod
    def _is_damage(answer: str) -> bool:
        """Whether an answer says that the line arrived damaged and was not executed."""
        reason = wire.split_finger(answer)[1].removeprefix("err ")
        return reason.startswith(_NOT_EXECUTED)

    def _refusal(
        self, line: str, answer: str, finger: int | None, content: str
    ) -> DisplayError:
        if self._is_damage(answer):
            return LineDamaged(line, answer, finger)
        refused = Refused(line, answer, finger)
        tripped = _TRIPPED.search(content)
        trip = self._trips.get(finger or 0)
        fault = tripped.group(1) if tripped else trip.fault if trip else None
        if fault is None or wire.split_finger(line)[1] == "clear":
            return refused
        error = self._tripped_error(fault, finger, f"'{line}' is refused: '{answer}'")
        error.__cause__ = refused
        return error

    def _tripped_error(self, fault: str, finger: int | None, doing: str) -> DeviceTripped:
        if self.fingers == 1:
            finger = None
        try:
            cause = self.ask("cause", Cause.read, finger)
        except DisplayError:
            cause = None
        return DeviceTripped(fault, finger, cause, doing)

    def abort(self, finger: int | None) -> None:
        """Switches the bridge off, at once: does not wait for the answer to a line of another thread, and may be repeated."""
        if self._closing:
            raise Closed("'abort' is not sent: the display has been closed, and its bridge switched off")
        line = "abort" if finger is None else f"@{finger} abort"
        if not self._command_lock.acquire(blocking=False):
            self._send_abort_at_once(line)
            self._command_lock.acquire()
        try:
            self._repeat(line)
        finally:
            self._command_lock.release()

    def _send_abort_at_once(self, line: str) -> None:
        """Sends `abort` before the answer to another line is there. Whoever waits for that gives up."""
        with self._answered:
            self._aborts_sent += 1
            self._out_of_step = True
            self._answered.notify_all()
        # Even if nothing can be received any more. After a line end it is a line of its own.
        self._write("\n" + (wire.with_checksum(line) if self._checksums else line))

    def set_stream(self, finger: int | None, stream: Stream) -> None:
        """Chooses telemetry of a finger, or of all."""
        old = [self._stream_all, *self._stream_own.values()] if finger is None else [self._stream_of(finger)]
        if any(one.interval_ms and one.fields != stream.fields for one in old):
            self.tell("stream 0", finger)
            time.sleep(FIELD_CHANGE_S)
        self.tell(self._stream_line(stream), finger)

    def set_checksums(self, on: bool) -> None:
        """Checksums on all lines, or on none, also after a restart of the device."""
        self.tell("checksum on" if on else "checksum off")
        self._wants_checksums = on

    @staticmethod
    def _stream_line(stream: Stream) -> str:
        names = "" if stream.fields == TELEMETRY_FIELDS else " " + " ".join(stream.fields)
        return f"stream {stream.interval_ms}{names if stream.interval_ms else ''}"

    def store(self, line: str) -> None:
        """`save` or `forget`, which restart the device; what this end had switched on is switched on again."""
        self.tell(line, timeout_s=max(self.timeout_s, RESTART_TIMEOUT_S))
        with self._command_lock:
            self._restore_after_restart(asked=True)

    def _restore_after_restart(self, asked: bool = False) -> None:
        """Switches on again what the device has forgotten by its restart and this end relies on."""
        streams: list[tuple[int | None, Stream]] = [(None, self._stream_all), *self._stream_own.items()]
        events = self.events_reported
        self._note_restart(asked)
        lines = ["checksum on"] if self._wants_checksums else []
        for finger, stream in streams:
            if stream.interval_ms:
                lines.append(("" if finger is None else f"@{finger} ") + self._stream_line(stream))
        if events:
            lines.append("events on")
        for line in lines:
            self._repeat(line)

    def _note_restart(self, asked: bool = False) -> None:
        self.restarts += not asked
        self._checksums = False
        self._stream_all, self._stream_own = OFF_STREAM, {}
        self._last_tick.clear()
        self._trips.clear()
        self.events_reported = False
        self.telemetry.forget_latest()
        self.clock.restart()

    # One line and its answer

    def _exchange(self, line: str, timeout_s: float) -> str:
        """Sends a line once and waits for its answer."""
        room = wire.LINE_MAX_BYTES - (wire.CHECKSUM_BYTES if self._checksums else 0)
        if not line.strip() or len(line) > room or not all(" " <= character <= "~" for character in line):
            raise NotSendable(
                f"'{line}' cannot be sent: a line has 1 to {room} printable ASCII characters", line
            )
        with self._answered:
            # An answer that nobody waited for: a line was divided, or its answer came late.
            if self._answers:
                self._out_of_step = True
        if self._out_of_step:
            self._synchronise(timeout_s)
        before = self._checksums
        with self._answered:
            self._answers.clear()
            self._expected = line
            aborts = self._aborts_sent
            # Until the answer is there; also if the wait ends by an interrupt.
            self._out_of_step = True
        self._transmit(line)
        if line in ("checksum off", "save", "forget"):
            # The answer has no checksum, unless the line is refused.
            self._checksums = False
        try:
            kind, answer = self._answer(line, timeout_s, aborts)
        except BaseException:
            self._checksums = before
            raise
        if kind is _Kind.UNCHECKED:
            self._synchronise(timeout_s)
            raise NotUnderstood(line, answer)
        if not _is_ok(answer):
            self._checksums = before
        return answer

    def _answer(self, line: str, timeout_s: float, aborts: int) -> tuple[_Kind, str]:
        """The next answer, intact or without a checksum."""
        begin_s = time.perf_counter()
        end_s = min(begin_s + timeout_s, self._deadline_s)
        damaged: str | None = None
        with self._answered:
            while True:
                if self._aborts_sent != aborts:
                    raise _AbortSent
                while self._answers:
                    kind, text = self._answers.popleft()
                    if kind is _Kind.DAMAGED:
                        damaged = text
                        continue
                    if kind is _Kind.ANSWER:
                        self._out_of_step = False
                    return kind, text
                self.raise_if_broken()
                rest_s = end_s - time.perf_counter()
                if rest_s <= 0:
                    waited_s = round(max(end_s - begin_s, 0.0), 1)
                    raise NoAnswer(line, waited_s) if damaged is None else NotUnderstood(line, damaged)
                # In slices: on Windows a wait cannot be interrupted.
                self._answered.wait(min(rest_s, 0.1))

    def _synchronise(self, timeout_s: float) -> None:
        """Makes sure that the next answer is that of the next line: sends a line whose answer, an error, repeats a word that no
        other answer has, and discards everything before that answer. Whether it has a checksum shows if the device has
        restarted; twice, because a damaged line may have lost it."""
        unchecked = 0
        for attempt in range(ATTEMPTS):
            with self._answered:
                self._out_of_step = True
                self._expected = None
                aborts = self._aborts_sent
            self._synchronization = (self._synchronization + 1) % (1 << 32)
            line = f"synchronize-{self._synchronization:08x}"
            self._transmit(line, after="\n")
            kind, text = _Kind.DAMAGED, ""
            # One deadline for all answers: other machines may go on saying `ok` for ever.
            end_s = time.perf_counter() + timeout_s
            try:
                while f"'{line}'" not in text:
                    kind, text = self._answer(line, end_s - time.perf_counter(), aborts)
            except NotUnderstood:
                if attempt + 1 == ATTEMPTS:
                    raise
                continue
            except NoAnswer as error:
                if text:
                    raise NotUnderstood(line, text) from error
                raise
            if kind is _Kind.ANSWER:
                with self._answered:
                    if self._aborts_sent == aborts:
                        self._out_of_step = False
                return
            unchecked += 1
            if unchecked == 2:
                self._checksums = False
                raise _Restarted
        raise NotUnderstood(line, text)

    def _transmit(self, line: str, after: str = "") -> None:
        """Sends a line. `after` a line end it is a line of its own even if an interrupt has cut the one before."""
        self._send(after + (wire.with_checksum(line) if self._checksums and line else line))

    def _send(self, line: str) -> None:
        self.raise_if_broken()
        self._write(line)

    def _write(self, line: str) -> None:
        try:
            with self._write_lock:
                self.link.send(line.encode("ascii") + b"\n")
                self._last_sent_s = time.perf_counter()
        except LineBroken as error:
            self._break(str(error))
            raise

    # The thread that reads

    def _read_lines(self) -> None:
        splitter = wire.LineSplitter()
        try:
            while not self._ended:
                received = self.link.receive()
                at_s = time.perf_counter()
                for line in splitter.lines(received):
                    self._sort(line, at_s)
                if time.perf_counter() - self._last_sent_s >= KEEP_ALIVE_S:
                    self._send("")
        except LineBroken as error:
            self._break(str(error))
        except Exception as error:
            log.exception("the thread that reads has failed")
            self._break(f"the thread that reads has failed: {error}")

    def _break(self, why: str) -> None:
        if self._broken is None:
            self._broken = why
        for condition in (self._answered, self.telemetry.changed, self.events.changed):
            with condition:
                condition.notify_all()

    def _sort(self, line: str, at_s: float) -> None:
        """Puts a line where it belongs."""
        if not line:
            return
        content, right = wire.strip_checksum(line)
        # Only now, because the checksum is that of the line as it was sent.
        content, line = wire.escaped(content), wire.escaped(line)
        finger, rest = wire.split_finger(content)
        if rest.startswith("err busy: "):
            self._busy = rest.removeprefix("err busy: ")
        if self._checksums and right is not True:
            if right is None and wire.is_answer(rest):
                self._put_answer(_Kind.UNCHECKED, content)
            else:
                self._damaged += 1
                self._put_answer(_Kind.DAMAGED, line)
            return
        if wire.is_answer(rest):
            self._put_answer(_Kind.ANSWER, content)
        elif not self._put_event(finger or 0, rest, at_s) and not self._put_telemetry(finger or 0, rest, at_s):
            self._damaged += 1
            self._put_answer(_Kind.DAMAGED, line)

    def _put_answer(self, kind: _Kind, text: str) -> None:
        with self._answered:
            if kind is _Kind.ANSWER and self._expected is not None:
                if _is_ok(text):
                    self._note_accepted(self._expected)
                self._expected = None
            if kind is _Kind.DAMAGED and self._expected is None:
                # Noise between the lines: nobody waits for it.
                return
            self._answers.append((kind, text))
            self._answered.notify_all()

    def _note_accepted(self, line: str) -> None:
        """Takes note of what an accepted line changes in the lines that follow its answer."""
        finger, content = wire.split_finger(line)
        words = content.split()
        if words[0] == "stream":
            # The device rounds a fraction of a millisecond up.
            stream = Stream.of(math.ceil(float(words[1])), words[2:])
            if finger is None:
                self._stream_all, self._stream_own = stream, {}
            else:
                self._stream_own[finger] = stream
            self._last_tick.clear()
            self._heard_s = time.perf_counter()
        elif content == "checksum on":
            self._checksums = True
        elif words[0] == "events":
            self.events_reported = content == "events on"

    def _put_event(self, finger: int, content: str, at_s: float) -> bool:
        parsed = parse_event(content)
        if parsed is None:
            return False
        tick, microseconds, kind = parsed
        self.clock.observe(tick, at_s)
        # What has arrived has happened.
        host_s = min(self.clock.time_of(tick) + 1e-6 * microseconds, at_s)
        event = Event(kind, tick, microseconds, finger, host_s, at_s)
        self.events.put(event)
        self.callbacks.occurred(event)
        return True

    def _put_telemetry(self, finger: int, content: str, at_s: float) -> bool:
        stream = self._stream_of(finger)
        parsed = parse_line(content, stream.fields)
        if parsed is None:
            return False
        tick, state, remark = parsed.tick, parsed.state, parsed.remark
        self._heard_s = at_s
        self.clock.observe(tick, at_s)
        # What has arrived has happened.
        host_s = min(self.clock.time_of(tick), at_s)
        lost = 0
        last = self._last_tick.get(finger)
        self._last_tick[finger] = tick
        if last is not None and stream.interval_ms:
            passed = (tick - last) % (1 << 32)
            # Ticks that go back are of a device that has restarted.
            if passed < 1 << 31:
                lost = max(0, passed // stream.interval_ms - 1)
        self._lost += lost
        before = (tick, finger, state, *parsed.values, remark)
        self.telemetry.put((*before, host_s, at_s, lost, *parsed.named))
        # After the row: who sees the trip sees the row that says so.
        if state != "tripped":
            self._trips.pop(finger, None)
        elif finger not in self._trips:
            self._trips[finger] = trip = Trip(finger, remark, tick, host_s)
            self.callbacks.occurred(trip)
        return True

    def _stream_of(self, finger: int) -> Stream:
        return self._stream_own.get(finger, self._stream_all)

    # How it is

    @property
    def counts(self) -> LineCounts:
        """Lines that were lost, damaged or overwritten so far."""
        return LineCounts(self._lost, self._damaged, self.telemetry.overwritten)

    @property
    def guarded(self) -> bool:
        """Whether telemetry of every finger streams, without which the device does not trip when this end falls silent."""
        return all(self._stream_of(finger).interval_ms for finger in range(self.fingers))

    @property
    def closed(self) -> bool:
        """Whether `close` has begun."""
        return self._closing

    def trip(self, finger: int | None) -> Trip | None:
        """The trip that the last telemetry of a finger, or of any, shows."""
        if finger is None:
            return next(iter(list(self._trips.values())), None)
        return self._trips.get(finger)

    def stream_in_words(self) -> str:
        """What streams, for messages."""
        intervals = [self._stream_of(finger).interval_ms for finger in range(self.fingers)]
        if not any(intervals):
            return "no telemetry streams: stream() switches it on"
        return "telemetry streams every " + ", ".join(f"{interval} ms" for interval in intervals)

    def raise_if_broken(self) -> None:
        """Raises what ended the connection."""
        if self._broken is None:
            return
        if self._busy is not None:
            raise DeviceBusy(f"{self.link.name} is busy: {self._busy}")
        raise LineBroken(self._broken)

    def raise_if_unusable(self) -> None:
        """Raises `Closed`, or what ended the connection; a device whose telemetry is missing is asked, which raises
        `DeviceRestarted` or `LineBroken`."""
        if self._closing:
            raise Closed("the display has been closed")
        self.raise_if_broken()
        self._ask_if_silent()

    def _ask_if_silent(self) -> None:
        """Asks a device that should stream and does not: after a reset, or with its supply off, it does neither that nor
        anything else."""
        intervals_ms = [self._stream_of(finger).interval_ms for finger in range(self.fingers)]
        longest_s = 1e-3 * max(intervals_ms)
        silent_s = time.perf_counter() - self._heard_s
        if longest_s == 0 or silent_s < max(SILENT_S, SILENT_INTERVALS * longest_s) or self.reads_here:
            return
        try:
            self.query("state")
        except (NoAnswer, NotUnderstood) as error:
            raise LineBroken(
                f"{self.link.name}: no telemetry for {silent_s:.1f} s, and {error}: its supply or the line is interrupted"
            ) from error
        with self._command_lock:
            if self._checksums or time.perf_counter() - self._heard_s < silent_s:
                # It answers and has forgotten nothing: the telemetry was lost on its way, or comes again.
                self._heard_s = time.perf_counter()
                return
            # Without checksums the answer does not show a restart; that the stream has ended does.
            raise self._restarted("state")

    def raise_if_tripped(self, finger: int | None, doing: str) -> None:
        """Raises `DeviceTripped` if telemetry shows a trip."""
        trip = self.trip(finger)
        if trip is not None:
            raise self._tripped_error(trip.fault, trip.finger, doing)
