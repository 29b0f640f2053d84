"""Measures the line to a device: round trip of a question, delay from a landing to its event, telemetry without loss.

    python measure_line.py                       # a simulated device, in real time on this computer
    python measure_line.py --port /dev/ttyACM0   # without the landing
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from thermal_display import Display


def show(what: str, times_s: list[float]) -> None:
    """Prints percentiles of times."""
    median, p90, p99 = 1e3 * np.percentile(times_s, [50, 90, 99])
    print(f"{what}: median {median:.2f} ms, 90 % {p90:.2f}, 99 % {p99:.2f}, of {len(times_s)}")


def main() -> None:
    parser = argparse.ArgumentParser(description="Measures the line to a device.")
    parser.add_argument("--port", help="serial port of the device; without it the device is simulated")
    parser.add_argument("--seconds", type=float, default=20.0, help="of telemetry at each rate")
    arguments = parser.parse_args()
    with Display.open(arguments.port) if arguments.port else Display.simulated(surroundings=True) as display:
        round_trips_s = []
        for _ in range(1000):
            begin_s = time.perf_counter()
            display.law()
            round_trips_s.append(time.perf_counter() - begin_s)
        show("round trip of a question", round_trips_s)
        if display.simulator is not None:
            display.material("copper")
            display.arm(wait_s=10)
            display.start()
            landings_s = []
            for _ in range(40):
                # The device's time stands still while the force is set and goes on right after.
                display.simulator.press(2.0)
                begin_s = time.perf_counter()
                landings_s.append(display.events.wait("land", timeout_s=5).received_s - begin_s)
                display.simulator.press(0.0)
                display.events.wait("lift", timeout_s=5)
            show("force of 2 N to event 'land' at this end", landings_s)
            display.abort()
        for interval_ms in (10, 5, 2, 1):
            before = display.counts
            display.stream(interval_ms)
            display.telemetry.take()
            begin_s = time.perf_counter()
            rows = display.telemetry.wait(int(arguments.seconds * 1e3 / interval_ms), timeout_s=10 * arguments.seconds)
            seconds = time.perf_counter() - begin_s
            lost = display.counts.lost - before.lost
            damaged = display.counts.damaged - before.damaged
            late_ms = 1e3 * (rows["received_s"] - display.clock.times_of(rows["tick"]))
            print(
                f"telemetry every {interval_ms} ms: {len(rows)} rows in {seconds:.1f} s, {lost} lost, {damaged} damaged, "
                f"late by {np.percentile(late_ms, 50):.2f} ms (median), {np.percentile(late_ms, 99):.2f} ms (99 %)"
            )


if __name__ == "__main__":
    main()
