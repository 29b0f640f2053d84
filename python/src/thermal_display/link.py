"""Lines to a device: serial port and TCP."""

from __future__ import annotations

import select
import socket
from typing import Protocol

import serial

from .errors import DeviceBusy, LineBroken

BAUD = 1_000_000
RECEIVE_S = 0.05
"""Longest wait for bytes, s: how soon keep-alive and end are thought of."""
WRITE_TIMEOUT_S = 1.0
"""A line that takes no bytes for so long counts as broken. The longest line takes 1 ms at this baud rate."""


class Link(Protocol):
    """Bytes to a device and from it. `send` and `receive` may be called by two threads at a time."""

    name: str

    def send(self, data: bytes) -> None:
        """Sends bytes; raises `LineBroken`."""

    def receive(self) -> bytes:
        """The bytes that have come, after at most `RECEIVE_S`, perhaps none; raises `LineBroken`."""

    def close(self) -> None:
        """Releases the port."""


class SerialLink:
    """A serial port, for this program alone."""

    def __init__(self, port: str) -> None:
        self.name = port
        try:
            # pyserial raises ValueError for a baud rate that the port does not have.
            self._port = serial.Serial(
                port, BAUD, timeout=RECEIVE_S, write_timeout=WRITE_TIMEOUT_S, exclusive=True
            )
        except (serial.SerialException, OSError, ValueError) as error:
            text = str(error)
            if "exclusively lock" in text or "busy" in text.lower() or "PermissionError" in text:
                raise DeviceBusy(f"{port} is open in another program: {text}") from error
            hint = (
                "; is your user in the group that owns the port (dialout on Debian)?"
                if "Permission denied" in text
                else ""
            )
            raise LineBroken(f"cannot open {port}: {text}{hint}") from error

    def send(self, data: bytes) -> None:
        try:
            self._port.write(data)
        except (serial.SerialException, OSError, TypeError) as error:
            raise LineBroken(f"{self.name}: {error}") from error

    def receive(self) -> bytes:
        try:
            first: bytes = self._port.read(1)
            if not first:
                return first
            rest: bytes = self._port.read(self._port.in_waiting)
            return first + rest
        # pyserial raises TypeError if the port is closed during a read.
        except (serial.SerialException, OSError, TypeError) as error:
            raise LineBroken(f"{self.name}: {error}") from error

    def close(self) -> None:
        self._port.close()


class TcpLink:
    """A TCP connection, to a simulated device or a serial server."""

    def __init__(self, address: str, timeout_s: float = 5.0) -> None:
        self.name = address
        host, colon, port = address.rpartition(":")
        if not colon or not port.isdigit():
            raise ValueError(f"'{address}' is no address; allowed is HOST:PORT, such as 127.0.0.1:4000")
        try:
            self._socket = socket.create_connection((host.strip("[]"), int(port)), timeout_s)
        except OSError as error:
            raise LineBroken(f"cannot connect to {address}: {error}") from error
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.settimeout(WRITE_TIMEOUT_S)

    def send(self, data: bytes) -> None:
        try:
            self._socket.sendall(data)
        except OSError as error:
            raise LineBroken(f"{self.name}: {error}") from error

    def receive(self) -> bytes:
        try:
            readable, _, _ = select.select([self._socket], [], [], RECEIVE_S)
            if not readable:
                return b""
            data = self._socket.recv(65536)
        # select raises ValueError if the socket is closed.
        except (OSError, ValueError) as error:
            raise LineBroken(f"{self.name}: {error}") from error
        if not data:
            raise LineBroken(f"{self.name}: the device has closed the connection")
        return data

    def close(self) -> None:
        self._socket.close()
