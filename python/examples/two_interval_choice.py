"""A two-interval forced choice (2AFC): which of two cold pulses was colder? Writes a row for each trial to a CSV file.

    python two_interval_choice.py --simulated --out choice.csv             # you answer 1 or 2
    python two_interval_choice.py --port /dev/ttyACM0 --out choice.csv
    python two_interval_choice.py --simulated --observer 0.3 --trials 4    # a simulated observer with a noise of 0.3 K answers

A row is written, and the file flushed, at the end of its trial: what ends the program loses the trial that runs, and no other.
"""

from __future__ import annotations

import argparse
import csv
import itertools
import sys
import time
from pathlib import Path

import numpy as np

from thermal_display import Display, DisplayError

BASE_C = 33.0
STANDARD_K = -4.0
"""Change of the standard pulse, K."""
DIFFERENCES_K = (0.25, 0.5, 1.0, 2.0)
"""By how much the other one is colder, K."""
RATE_K_S = 8.0
HOLD_S = 0.5
PAUSE_S = 0.5
COLUMNS = [
    "trial",
    "difference_k",
    "colder_interval",
    "answer",
    "correct",
    "response_time_s",
    "onset_1_s",
    "onset_2_s",
    "display_min_1_c",
    "display_min_2_c",
    "skin_c",
    "force_mean_n",
    "lost",
]


def interval(display: Display, change_k: float) -> tuple[float, np.ndarray[tuple[int], np.dtype[np.void]]]:
    """Gives a pulse; its onset by `time.perf_counter()`, s, and the telemetry from there to its end."""
    display.events.clear()
    display.telemetry.take()
    display.pulse(BASE_C, BASE_C + change_k, RATE_K_S, HOLD_S, RATE_K_S)
    start = display.events.wait("start", timeout_s=5)
    end = display.events.wait("end", timeout_s=60)
    rows = display.telemetry.take()
    return start.host_s, rows[(rows["tick"] >= start.tick) & (rows["tick"] <= end.tick)]


def answer(observer_k: float | None, minima_c: tuple[float, float], random: np.random.Generator) -> str:
    """`1` or `2`: of a person at the keyboard, or of an observer whose noise has this standard deviation, K."""
    if observer_k is not None:
        felt_c = np.array(minima_c) + random.normal(0.0, observer_k, 2)
        return str(1 + int(np.argmin(felt_c)))
    while True:
        typed = input("Which one was colder, 1 or 2? ").strip()
        if typed in ("1", "2"):
            return typed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    device = parser.add_mutually_exclusive_group(required=True)
    device.add_argument("--port", help="serial port of the device")
    device.add_argument("--simulated", action="store_true", help="a simulated device; needs the program hil-sim")
    parser.add_argument("--out", type=Path, help="CSV file; without it the rows go to standard output")
    parser.add_argument("--trials", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1, help="of order and observer")
    parser.add_argument("--observer", type=float, metavar="K", help="noise of a simulated observer, K")
    arguments = parser.parse_args()
    random = np.random.default_rng(arguments.seed)
    # Blocks that have each difference in each interval once, in random order.
    block = list(itertools.product(DIFFERENCES_K, (1, 2)))
    blocks = -(-arguments.trials // len(block))
    plan = [block[i] for _ in range(blocks) for i in random.permutation(len(block))][: arguments.trials]
    out = sys.stdout if arguments.out is None else arguments.out.open("w", newline="", encoding="utf-8")
    with out, Display.simulated() if arguments.simulated else Display.open(arguments.port) as display:
        writer = csv.DictWriter(out, COLUMNS)
        writer.writeheader()
        display.arm(wait_s=10)
        display.hold(BASE_C, 2.0)
        display.telemetry.wait_for(lambda sample: abs(sample.display_c - BASE_C) < 0.05, timeout_s=30)
        for trial, (difference_k, colder) in enumerate(plan, 1):
            changes_k = [STANDARD_K - (difference_k if number == colder else 0.0) for number in (1, 2)]
            onset_1_s, rows_1 = interval(display, changes_k[0])
            time.sleep(PAUSE_S)
            onset_2_s, rows_2 = interval(display, changes_k[1])
            minima_c = (float(rows_1["display_c"].min()), float(rows_2["display_c"].min()))
            asked_s = time.perf_counter()
            answered = answer(arguments.observer, minima_c, random)
            rows = np.concatenate([rows_1, rows_2])
            writer.writerow(
                {
                    "trial": trial,
                    "difference_k": difference_k,
                    "colder_interval": colder,
                    "answer": answered,
                    "correct": int(answered == str(colder)),
                    "response_time_s": f"{time.perf_counter() - asked_s:.3f}",
                    "onset_1_s": f"{onset_1_s:.4f}",
                    "onset_2_s": f"{onset_2_s:.4f}",
                    "display_min_1_c": f"{minima_c[0]:.3f}",
                    "display_min_2_c": f"{minima_c[1]:.3f}",
                    "skin_c": f"{rows['skin_c'][0]:.2f}",
                    "force_mean_n": f"{np.nanmean(rows['force_n']):.3f}",
                    "lost": int(rows["lost_before"].sum()),
                }
            )
            out.flush()


if __name__ == "__main__":
    try:
        main()
    except DisplayError as error:
        raise SystemExit(f"two_interval_choice: {error}") from error
