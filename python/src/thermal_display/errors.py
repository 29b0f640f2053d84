"""What can go wrong, each as a class of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .replies import Cause


class DisplayError(Exception):
    """Base of all errors of this package."""


class LineBroken(DisplayError):
    """The device can no longer be reached: cable pulled, port closed, simulated device ended."""


class DeviceBusy(DisplayError):
    """Another program is connected to the device, or has its port open."""


class Closed(DisplayError):
    """The `Display` has been closed."""


class SimulatorMissing(DisplayError):
    """The program `hil-sim` was not found or did not start."""


class CommandError(DisplayError):
    """A line has no usable answer."""

    def __init__(self, message: str, line: str) -> None:
        super().__init__(message)
        self.line = line
        """The line, without checksum."""


class NotSendable(CommandError):
    """The line is longer than the protocol allows, or not printable ASCII."""


class Refused(CommandError):
    """The device refused the line. The answer says what is wrong and what is allowed."""

    def __init__(self, line: str, answer: str, finger: int | None = None) -> None:
        super().__init__(f"the device answers '{line}' with '{answer}'", line)
        self.answer = answer
        """The answer, with its `err`."""
        self.finger = finger
        """The finger that refused, if the answer names one."""

    @property
    def reason(self) -> str:
        """The answer without finger and `err`."""
        _, _, reason = self.answer.partition("err")
        return reason.strip()


class LineDamaged(Refused):
    """The line arrived damaged and was not executed; it may be sent again."""


class DeviceTripped(DisplayError):
    """A fault has switched the bridge off. `clear()` clears it once it is no longer present."""

    def __init__(
        self, fault: str, finger: int | None, cause: Cause | None, doing: str
    ) -> None:
        where = "" if finger is None else f"finger {finger}: "
        readings = "" if cause is None else f" ({cause.summary()})"
        super().__init__(
            f"{where}the device is tripped by {fault}{readings}, so {doing}; "
            "clear() clears a fault that is no longer present"
        )
        self.fault = fault
        """Word of the fault, such as `host-silent`."""
        self.finger = finger
        """The finger that tripped, on a device with several."""
        self.cause = cause
        """Readings at the time of the trip, if they could be asked for."""


class NoAnswer(CommandError):
    """The device did not answer in time. A line that changes something may have been executed all the same."""

    def __init__(self, line: str, timeout_s: float) -> None:
        super().__init__(f"the device does not answer '{line}' within {timeout_s:g} s", line)
        self.timeout_s = timeout_s
        """How long was waited, s."""


class NotUnderstood(CommandError):
    """What came is no answer to the line, or came damaged."""

    def __init__(self, line: str, answer: str) -> None:
        super().__init__(f"the answer to '{line}' is not understood: '{answer}'", line)
        self.answer = answer
        """What came."""


class Interrupted(CommandError):
    """Another thread sent `abort` while this line waited for its answer. The bridge is off; whether the line was executed
    before is not known."""

    def __init__(self, line: str) -> None:
        super().__init__(
            f"another thread sent 'abort' while '{line}' waited for its answer; "
            "whether the line was executed before that is not known",
            line,
        )


class DeviceRestarted(CommandError):
    """The device has restarted: its bridge is off, and material, object, course and mode must be set again.
    Checksums, telemetry and events are switched on again by this package."""

    def __init__(self, line: str) -> None:
        super().__init__(
            f"the device has restarted, which the answer to '{line}' shows: it has forgotten checksums and telemetry. "
            "Its bridge is off; set material, object and course again",
            line,
        )


class BridgeNotOff(DisplayError):
    """It could not be confirmed that the bridge is off when the `Display` was closed."""

    def __init__(self, why: str, guarded: bool) -> None:
        guard = (
            "the device trips by host-silent 2 s after the last line that reached it"
            if guarded
            else "telemetry did not stream, so the device will NOT switch off by itself"
        )
        super().__init__(
            f"could not confirm that the bridge is off: {why}. The display may still be driven; {guard}. "
            "The emergency stop works always"
        )
        self.guarded = guarded
        """Whether the device's own guard, the fault `host-silent`, was in force."""


class TelemetryTimeout(DisplayError):
    """The telemetry that was waited for did not come in time."""


class EventTimeout(DisplayError):
    """The event that was waited for did not come in time."""


class StateTimeout(DisplayError):
    """The device did not reach the state that was waited for in time."""
