"""A line with a device at its end that is only as clever as the tests need, and that can be made to fail."""

from __future__ import annotations

import queue
import threading
from collections import defaultdict

from thermal_display import LineBroken
from thermal_display.wire import split_finger, strip_checksum, with_checksum

STATE = "ok state={} fault={} material=- object_c=room mode=contact setpoint_c=- body=half-space"


class FakeDevice:
    """Takes lines, answers them, and keeps what it has received in `received`, without checksums.

    `failures` says what happens to the next lines of a content: `line-lost`, `line-damaged`, `answer-lost`, `answer-damaged`,
    `checksum-lost`, `late` (the answer comes just before the next one), `restart` (the line is lost in it), `silent` (no answer;
    `held` says that the line is there), `interrupt` (KeyboardInterrupt at this end while it is sent).
    """

    def __init__(self, fingers: int = 1) -> None:
        self.name = "fake"
        self.fingers = fingers
        self.received: list[str] = []
        self.failures: defaultdict[str, list[str]] = defaultdict(list)
        self.answers: dict[str, str] = {}
        self.answers_without_checksums: dict[str, str] = {}
        self.checksums = False
        self.state = "off"
        self.fault = "-"
        self.closed = False
        self.unplugged = False
        self.held = threading.Event()
        self._to_host: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._rest = b""
        self._late: str | None = None

    # The host's side: a `Link`.

    def send(self, data: bytes) -> None:
        with self._lock:
            if self.unplugged:
                raise LineBroken("fake: unplugged")
            self._rest += data
            *lines, self._rest = self._rest.split(b"\n")
            for line in lines:
                self._take(line.decode("ascii"))

    def receive(self) -> bytes:
        try:
            data = self._to_host.get(timeout=0.02)
        except queue.Empty:
            data = b""
        if self.unplugged:
            raise LineBroken("fake: unplugged")
        return data

    def close(self) -> None:
        self.closed = True

    # The device's side.

    def say(self, line: str) -> None:
        """Sends a line to the host as the device does."""
        self.raw((with_checksum(line) if self.checksums else line).encode("latin-1") + b"\n")

    def raw(self, data: bytes) -> None:
        """Sends bytes to the host."""
        self._to_host.put(data)

    def restart(self) -> None:
        """Forgets what a device forgets."""
        self.checksums = False
        self.state, self.fault = "off", "-"

    def lines(self, *words: str) -> list[str]:
        """The received lines that begin with one of these words."""
        return [line for line in self.received if split_finger(line)[1].split(" ")[0] in words]

    def _take(self, line: str) -> None:
        content, right = strip_checksum(line)
        if not content:
            self.received.append("")
            return
        failure = self.failures[content].pop(0) if self.failures[content] else ""
        if failure == "interrupt":
            raise KeyboardInterrupt
        if failure == "line-lost":
            return
        if failure == "restart":
            self.restart()
            return
        if right is False or failure == "line-damaged":
            self.say("err checksum 00 is wrong, the line has 01; send the line again")
            return
        if right is None and self.checksums and split_finger(content)[1] != "abort":
            self.say("err checksum missing, the line has 01; send the line again with it")
            return
        self.received.append(content)
        finger, command = split_finger(content)
        answer = self._execute(command)
        if finger is not None:
            answer = f"@{finger} {answer}"
        if command == "checksum off":
            self.checksums = False
        if command == "checksum on":
            self.checksums = True
        late, self._late = self._late, answer if failure == "late" else None
        if late is not None:
            self.say(late)
        if failure == "silent":
            self.held.set()
        elif failure == "answer-damaged":
            self.raw(with_checksum(answer).replace("ok", "oj").encode() + b"\n")
        elif failure == "checksum-lost":
            self.raw(answer.encode() + b"\n")
        elif failure not in ("answer-lost", "late"):
            self.say(answer)

    def _execute(self, command: str) -> str:
        if command in self.answers_without_checksums and not self.checksums:
            return self.answers_without_checksums[command]
        if command in self.answers:
            return self.answers[command]
        word = command.split(" ")[0]
        if word == "id":
            return (
                f"ok thermal-display 0.2.0 fingers={self.fingers} tick_hz=1000 scan_hz=16000 protocol=1 "
                "capabilities=upload,checksum,course"
            )
        if word == "state":
            return STATE.format(self.state, self.fault)
        if word == "cause":
            return "ok cause=-"
        if word.startswith("synchronize"):
            return f"err unknown command '{command}'; known: id"
        if command in ("save", "forget"):
            self.restart()
        if word == "abort":
            self.state = "ready"
        if word == "hold":
            self.state = "stimulus"
        if command.startswith("settings "):
            return f"ok set tile {command.split(' ')[1]}"
        if command == "settings":
            return "ok lines=8"
        return "ok"
