"""Lines, numbers and replies, without a device."""

from __future__ import annotations

import numpy as np
import pytest

from thermal_display import (
    FLUX_FIELDS,
    TELEMETRY_DTYPE,
    TELEMETRY_FIELDS,
    EventKind,
    State,
    TelemetryField,
    wire,
)
from thermal_display.device_clock import DeviceClock
from thermal_display.events import parse_event
from thermal_display.replies import Cause, DisplaySurface, Fields, FluxReport, Identity, Status
from thermal_display.telemetry import TelemetryBuffer, parse_line


@pytest.mark.parametrize(
    "line", ["checksum on*2C", "ok*04", "law pi*43", "law pi-10hz*7D", "checksum off*42"]
)
def test_checksums_are_those_of_the_protocols_examples(line: str) -> None:
    content = line.split("*")[0]
    assert wire.with_checksum(content) == line
    assert wire.strip_checksum(line) == (content, True)


@pytest.mark.parametrize("line", ["law pi-10hz*43", "ok*0", "ok*004", "ok*+4", "ok*zz", "ok*", "o\xff*04"])
def test_a_wrong_checksum_is_seen(line: str) -> None:
    assert wire.strip_checksum(line) == (line, False)


def test_every_single_damaged_byte_is_seen() -> None:
    line = wire.with_checksum("T 1234 contact 24.31939 24.3300 23.99 32.86 23.97 1.999 0.233 0.426 17 -")
    for index in range(len(line)):
        for bit in range(8):
            damaged = line[:index] + chr(ord(line[index]) ^ 1 << bit) + line[index + 1 :]
            _, right = wire.strip_checksum(damaged)
            # The case of a hexadecimal digit does not matter.
            assert right is not True or damaged.upper() == line.upper(), damaged


def test_commits_are_those_of_the_protocols_examples() -> None:
    plate = ["upload begin object 1 0.5", "upload row 0 2 40"]
    assert wire.upload_commit(plate) == "upload commit 21a54dda"
    course = ["upload begin course 3 absolute", "upload row 0 0 33", "upload row 1 2 25", "upload row 2 12 25"]
    assert wire.upload_commit(course) == "upload commit 94e568a7"


@pytest.mark.parametrize(
    ("line", "repeated"),
    [
        ("state", True),
        ("@3 state", True),
        ("settings 4", True),
        ("upload row 3 1 2", True),
        ("@1 upload row 3 1 2", True),
        ("law", True),
        ("law pi", False),
        ("finger mean", False),
        ("upload begin course 2 absolute", False),
        ("upload commit 00000000", False),
        ("save", False),
        ("hold 30", False),
        ("tune result", False),
        ("flux", True),
        ("flux zero", False),
        ("surface", True),
        ("surface nominal", False),
        ("contact", True),
        ("contact nominal", False),
        ("person", True),
        ("@0 person", True),
        ("person none", False),
        ("persons", True),
    ],
)
def test_questions_and_numbered_rows_only_may_be_repeated(line: str, repeated: bool) -> None:
    assert wire.may_be_repeated(line) is repeated


def test_control_characters_are_shown_by_their_numbers() -> None:
    for code in [*range(0x20), *range(0x7F, 0xA0)]:
        assert wire.escaped(f"a{chr(code)}b") == f"a\\u{{{code:x}}}b"
    assert wire.escaped("err 23 °C; \\u{1b}") == "err 23 °C; \\u{1b}"


def test_bytes_are_split_into_lines_wherever_they_are_cut() -> None:
    data = b"ok\r\n\nE 1 0 land\nT 1 off - - - - - - 0 0 0 -\n"
    for cut in range(len(data)):
        splitter = wire.LineSplitter()
        lines = splitter.lines(data[:cut]) + splitter.lines(data[cut:])
        assert lines == ["ok", "", "E 1 0 land", "T 1 off - - - - - - 0 0 0 -"]


def test_noise_without_a_line_end_does_not_fill_the_memory() -> None:
    splitter = wire.LineSplitter()
    lines = [line for _ in range(100) for line in splitter.lines(b"\xff" * 100)]
    assert sum(map(len, lines)) >= 100 * 100 - wire.PARTIAL_LINE_MAX_BYTES


@pytest.mark.parametrize(
    ("value", "text"), [(30, "30"), (30.5, "30.5"), (-0.0, "0"), (1e-6, "0.000001"), (1.38e7, "13800000")]
)
def test_numbers_have_no_exponent(value: float, text: str) -> None:
    assert wire.number(value, "value") == text


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_numbers_that_are_not_finite_are_not_sent(value: float) -> None:
    with pytest.raises(ValueError, match="setpoint_c is .*; allowed are finite"):
        wire.number(value, "setpoint_c")


def test_a_line_of_telemetry_is_read() -> None:
    line = "T 7 contact 24.31939 24.3300 23.99 - 23.97 1.999 0.233 0.426 17 limited"
    parsed = parse_line(line, TELEMETRY_FIELDS)
    assert parsed is not None
    assert (parsed.tick, parsed.state, parsed.remark) == (7, "contact", "limited")
    np.testing.assert_equal(parsed.values, [24.31939, 24.33, 23.99, np.nan, 23.97, 1.999, 0.233, 0.426, 17])
    np.testing.assert_equal(parsed.named[:3], [np.nan, np.nan, ""])


def test_a_line_with_chosen_fields_fills_their_columns() -> None:
    parsed = parse_line("T 7 preset 30.0000 1.5 -", ("display", "force"))
    assert parsed is not None
    np.testing.assert_equal(parsed.values, [np.nan, 30, np.nan, np.nan, np.nan, 1.5, np.nan, np.nan, -1])


def test_a_line_with_fields_of_the_flux_sensor_fills_their_columns() -> None:
    fields: tuple[TelemetryField, ...] = ("force", *FLUX_FIELDS)
    parsed = parse_line("T 7 contact 1.5 -1234.5 24.0125 trusted -", fields)
    assert parsed is not None
    assert (parsed.values[5], parsed.named[:3]) == (1.5, (-1234.5, 24.0125, "trusted"))
    parsed = parse_line("T 7 contact 1.5 - - - -", fields)
    assert parsed is not None
    np.testing.assert_equal(parsed.named[:3], [np.nan, np.nan, ""])


@pytest.mark.parametrize(
    "line",
    [
        "T",
        "T x off - - - - - - 0 0 0 -",
        "T 5000000000 off - - - - - - 0 0 0 -",
        "T 1 of - - - - - - 0 0 0 -",
        "T 1 off - - - - - - 0 0 0",
        "T 1 off - - - - 1.2.3 - 0 0 0 -",
        "E 1 0 land",
        "garbage",
    ],
)
def test_what_is_no_telemetry_is_not_read_as_such(line: str) -> None:
    assert parse_line(line, TELEMETRY_FIELDS) is None


def test_more_fields_than_chosen_are_not_taken_for_the_chosen() -> None:
    assert parse_line("T 1 off - - - - - - 0 0 0 -", ("display",)) is None


def test_an_event_is_read() -> None:
    assert parse_event("E 12 345 trigger") == (12, 345, EventKind.TRIGGER)
    assert parse_event("E 12 0 flux") == (12, 0, EventKind.FLUX)
    for line in ["E 12 345 touch", "E 12 land", "E x 0 land", "T 12 345 land"]:
        assert parse_event(line) is None


def test_replies_are_read() -> None:
    status = Status.read(
        Fields(
            "state=tripped fault=host-silent material=copper object_c=-3.50 mode=contact setpoint_c=- limited body=slab"
        )
    )
    assert (status.state, status.fault, status.object_c) == (State.TRIPPED, "host-silent", -3.5)
    assert (status.limited, status.body, status.setpoint_c) == (True, "slab", None)
    assert status.tuned is None
    armed = "state=armed fault=- material=- object_c=room mode=contact setpoint_c=34.00 body=half-space tile="
    assert [Status.read(Fields(armed + tile)).tuned for tile in ("tuned", "untuned")] == [True, False]
    assert Cause.read(Fields("cause=-")) is None
    assert FluxReport.read(Fields("flux=none")) is None
    flux = FluxReport.read(
        Fields(
            "flux=fitted counts_per_w_m2=0.119200 zero_counts=2051.250 lag_ms=5.000 resistance_mm2k_w=30.000 "
            "w_m2=-3.2 finger=trusted"
        )
    )
    assert flux == FluxReport(0.1192, 2051.25, 5.0, 30.0, -3.2, "trusted")
    surface = DisplaySurface.read(Fields("conductivity_w_mk=30.000 roughness_um=1.2500 slope_rad=0.11000"))
    assert surface == DisplaySurface(30, 1.25, 0.11)
    old = Identity.read(Fields("thermal-display 0.1.0 fingers=1 tick_hz=1000 scan_hz=16000"))
    assert (old.protocol, old.can("course")) == (None, False)
    with pytest.raises(ValueError, match="material= is missing"):
        Status.read(Fields("state=off fault=-"))


def _row(tick: int) -> tuple[object, ...]:
    row = np.zeros(1, dtype=TELEMETRY_DTYPE)
    row["tick"] = tick
    return tuple(row[0])


def test_the_ring_keeps_the_newest_rows_and_counts_the_others() -> None:
    ring = TelemetryBuffer(4)
    for tick in range(3):
        ring.put(_row(tick))
    assert list(ring.take()["tick"]) == [0, 1, 2]
    for tick in range(3, 10):
        ring.put(_row(tick))
    assert ring.waiting == 4
    assert list(ring.take()["tick"]) == [6, 7, 8, 9]
    assert ring.overwritten == 3
    assert len(ring.take()) == 0


def _arrivals(seconds: int, drift: float, seed: int = 1) -> list[tuple[int, float]]:
    """Ticks of a device whose clock is slow by `drift`, and arrivals that are late by 2 ms and more."""
    random = np.random.default_rng(seed)
    late_s = 2e-3 + random.exponential(3e-3, 100 * seconds)
    return [(10 * i, 50.0 + 0.01 * i * (1 + drift) + late) for i, late in enumerate(late_s)]


def test_the_clock_finds_offset_and_drift_below_irregular_delays() -> None:
    clock = DeviceClock()
    arrivals = _arrivals(30, 100e-6)
    for tick, at_s in arrivals:
        clock.observe(tick, at_s)
    # The delay that all lines have cannot be seen.
    expected_s = 50.0 + 20.0 * (1 + 100e-6) + 2e-3
    assert abs(clock.time_of(20_000) - expected_s) < 0.5e-3
    assert abs(clock.estimate.drift_ppm - 100) < 30
    ticks = [tick for tick, _ in arrivals[::50]]
    np.testing.assert_allclose(clock.times_of(ticks), [clock.time_of(tick) for tick in ticks], rtol=0, atol=1e-9)


def test_lines_that_wait_while_the_computer_sleeps_do_not_move_the_clock() -> None:
    clock = DeviceClock()
    for tick, at_s in _arrivals(12, 0.0):
        asleep = 2000 <= tick < 6000
        clock.observe(tick, 56.0 + 1e-6 * tick if asleep else at_s)
    assert abs(clock.time_of(4000) - 54.002) < 1e-3
    assert clock.estimate.error_s < 5e-3


def test_one_damaged_tick_does_not_move_the_clock_and_a_restart_begins_it_anew() -> None:
    clock = DeviceClock()
    for tick, at_s in _arrivals(5, 0.0):
        clock.observe(tick, at_s)
    before_s = clock.time_of(4000)
    clock.observe(4_000_000, 55.01)
    assert clock.time_of(4000) == before_s
    clock.observe(5010, 55.02)
    assert clock.estimate.restarts == 0
    clock.observe(3, 56.0)
    clock.observe(13, 56.01)
    assert clock.estimate.restarts == 1
    assert abs(clock.time_of(13) - 56.01) < 0.02


def test_ticks_beyond_32_bits_go_on() -> None:
    clock = DeviceClock()
    for i in range(300):
        clock.observe((2**32 - 1500 + 10 * i) % 2**32, 0.01 * i)
    assert abs(clock.time_of(10) - 1.51) < 0.02
    assert abs(clock.time_of(2**32 - 500) - 1.0) < 0.02
    np.testing.assert_allclose(clock.times_of([2**32 - 500, 10]), [1.0, 1.51], atol=0.02)
    assert clock.estimate.restarts == 0


def test_a_clock_that_has_seen_nothing_says_so() -> None:
    clock = DeviceClock()
    assert np.isnan(clock.time_of(3))
    assert np.isnan(clock.times_of([3, 4])).all()
