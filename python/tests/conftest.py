"""What the tests share."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable, Iterator
from types import TracebackType

import pytest
from fake_device import FakeDevice

from thermal_display import HIL_SIM_VARIABLE, Display, Simulator, SimulatorMissing, find_hil_sim

TIMEOUT_S = 0.4
"""Timeout of an answer of the fake device, which answers at once or never."""


@pytest.fixture
def fake() -> FakeDevice:
    return FakeDevice()


@pytest.fixture
def display(fake: FakeDevice) -> Iterator[Display]:
    """A display at the fake device, with checksums and telemetry."""
    display = Display(fake, timeout_s=TIMEOUT_S)
    fake.received.clear()
    yield display
    if not fake.closed and not fake.unplugged:
        display.close()


@pytest.fixture(scope="session")
def hil_sim() -> str:
    """Path of the program that simulates devices. Where nobody has named it, its tests are skipped."""
    try:
        return find_hil_sim()
    except SimulatorMissing as error:
        if HIL_SIM_VARIABLE in os.environ:
            raise
        pytest.skip(str(error))


@pytest.fixture
def serve(hil_sim: str) -> Iterator[Callable[..., Simulator]]:
    """Starts simulated devices, which end with the test."""
    started: list[Simulator] = []

    def start(**options: object) -> Simulator:
        simulator = Simulator(hil_sim, **options)  # type: ignore[arg-type]
        started.append(simulator)
        return simulator

    yield start
    for simulator in started:
        simulator.stop()


class Plain:
    """A second program at a device, which knows nothing of this package."""

    def __init__(self, address: str) -> None:
        host, _, port = address.rpartition(":")
        self._socket = socket.create_connection((host, int(port)), 5.0)
        self._socket.settimeout(5.0)
        self._stream = self._socket.makefile("rw", encoding="ascii", newline="\n")

    def query(self, line: str) -> str:
        """The answer to a line."""
        self._stream.write(line + "\n")
        self._stream.flush()
        while True:
            answer = self._stream.readline()
            assert answer, "the device has closed the connection"
            if not answer.startswith(("T ", "E ", "@")) or answer.split(" ")[1:2] in (["ok"], ["err"]):
                return answer.strip()

    def __enter__(self) -> Plain:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._stream.close()
        self._socket.close()
