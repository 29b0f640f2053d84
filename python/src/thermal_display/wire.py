"""Lines of the protocol: checksums, addresses of fingers, numbers."""

from __future__ import annotations

import functools
import math
import operator
import re
import zlib
from collections.abc import Iterable

LINE_MAX_BYTES = 96
"""Longest line to the device, bytes, with its checksum."""
CHECKSUM_BYTES = len("*00")
PARTIAL_LINE_MAX_BYTES = 1024
"""A line from the device without an end is delivered in parts of this size, so that noise cannot fill the memory."""


def checksum(content: bytes) -> int:
    """Exclusive or of all bytes."""
    return functools.reduce(operator.xor, content, 0)


def with_checksum(line: str) -> str:
    """The line with `*` and its checksum."""
    return f"{line}*{checksum(line.encode('ascii')):02X}"


def strip_checksum(line: str) -> tuple[str, bool | None]:
    """The content of a line, and whether its checksum is right; `None` if it has none."""
    content, star, digits = line.partition("*")
    if not star:
        return line, None
    if len(digits) != 2 or any(digit not in "0123456789abcdefABCDEF" for digit in digits):
        return line, False
    right = checksum(content.encode("latin-1", "replace")) == int(digits, 16)
    return (content, True) if right else (line, False)


_CONTROL_CHARACTER = re.compile("[\x00-\x1f\x7f-\x9f]")


def escaped(line: str) -> str:
    r"""A line from the device as it is shown: control characters, with which a terminal would do something, as `\u{1b}`."""
    return _CONTROL_CHARACTER.sub(lambda found: f"\\u{{{ord(found[0]):x}}}", line)


def split_finger(line: str) -> tuple[int | None, str]:
    """The finger at the beginning of a line, and the rest."""
    line = line.lstrip()
    if line.startswith("@"):
        address, _, rest = line[1:].partition(" ")
        if address.isascii() and address.isdigit():
            return int(address), rest
    return None, line


def is_answer(content: str) -> bool:
    """Whether a line without finger is an answer."""
    return content.split(" ", 1)[0] in ("ok", "err")


_QUESTIONS = frozenset(
    "id state cause board raw self-test law finger contact margins settings flux surface person persons".split()
)


def may_be_repeated(line: str) -> bool:
    """Whether a line may be executed twice: a question, or a numbered row of an upload."""
    words = split_finger(line)[1].split()
    if words[:1] == ["settings"] or words[:2] == ["upload", "row"]:
        return True
    return len(words) == 1 and words[0] in _QUESTIONS


def number(value: float, name: str, decimals: int = 9) -> str:
    """A number as the device reads it, without exponent."""
    value = float(value)
    if not math.isfinite(value):
        raise ValueError(f"{name} is {value}; allowed are finite numbers")
    text = f"{value:.{decimals}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text


def upload_commit(lines: Iterable[str]) -> str:
    """The line that ends an upload of these lines, with their CRC-32."""
    sent = "".join(f"{line}\n" for line in lines)
    return f"upload commit {zlib.crc32(sent.encode('ascii')):08x}"


class LineSplitter:
    """Splits received bytes into lines."""

    def __init__(self) -> None:
        self._rest = bytearray()

    def lines(self, received: bytes) -> list[str]:
        """The lines that are complete with these bytes, without line ends. Bytes are taken as Latin-1, so that a damaged
        byte is one character and fails the checksum."""
        self._rest += received
        end = self._rest.rfind(b"\n") + 1
        if len(self._rest) - end > PARTIAL_LINE_MAX_BYTES:
            end = len(self._rest)
        complete = bytes(self._rest[:end])
        del self._rest[:end]
        return [line.decode("latin-1").rstrip() for line in complete.splitlines()]
