"""A thermal cue in the form of a PsychoPy experiment: Begin Experiment, Begin Routine, Each Frame, End Routine, End Experiment.

In PsychoPy Builder put the body of each function below into the tab of the same name of a Code component, with `display` and
`cue` as they are here. As a Coder script it runs by itself:

    python psychopy_cue.py                          # a simulated device; needs the program hil-sim
    python psychopy_cue.py --port /dev/ttyACM0

Without PsychoPy the same functions run in a plain loop of 60 frames a second, and answers come from the terminal or, with
`--trials`, from nobody: so it can be tried on any computer.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from thermal_display import Display, DisplayError

try:
    from psychopy import core, event, visual
except ImportError:
    core = event = visual = None

FRAME_S = 1 / 60
CUE_S = 2.0
"""How long a cue is held, s."""
NEUTRAL_C = 33.0


class Cue:
    """A warm or cold cue of a trial, and what the device reports of it."""

    def __init__(self, display: Display) -> None:
        self.display = display
        self.rows: list[Any] = []
        self.onset_s = float("nan")
        self.offset_s = float("nan")

    # Begin Experiment: once, before the window opens.

    def begin_experiment(self) -> None:
        self.display.arm(wait_s=10)
        self.display.hold(NEUTRAL_C, 2.0)
        # The display comes from the room's temperature.
        self.display.telemetry.wait_for(lambda sample: abs(sample.display_c - NEUTRAL_C) < 0.1, timeout_s=30)

    # Begin Routine: `change_k` is a column of the conditions file.

    def begin_routine(self, change_k: float) -> None:
        self.rows = []
        self.onset_s = self.offset_s = float("nan")
        self.display.events.clear()
        self.display.telemetry.take()
        # The device times the cue itself; a late frame does not change it.
        self.display.pulse(NEUTRAL_C, NEUTRAL_C + change_k, rise_k_s=5, hold_s=CUE_S, return_k_s=5)

    # Each Frame: nothing here waits. Returns whether the routine goes on.

    def each_frame(self) -> bool:
        # Raises DeviceTripped if the device has switched itself off.
        self.display.check()
        rows = self.display.telemetry.take()
        if len(rows):
            self.rows.append(rows)
        for event_ in self.display.events.take():
            if event_.kind == "start":
                self.onset_s = event_.host_s
            elif event_.kind == "end":
                self.offset_s = event_.host_s
        return not np.isfinite(self.offset_s)

    # End Routine: what goes into the data file.

    def end_routine(self) -> dict[str, float]:
        rows = np.concatenate(self.rows) if self.rows else self.display.telemetry.take()
        return {
            "cue_onset_s": self.onset_s,
            "cue_offset_s": self.offset_s,
            "display_min_c": float(rows["display_c"].min()) if len(rows) else float("nan"),
            "display_max_c": float(rows["display_c"].max()) if len(rows) else float("nan"),
            "force_mean_n": float(np.nanmean(rows["force_n"])) if len(rows) else float("nan"),
            "lost": float(rows["lost_before"].sum()) if len(rows) else float("nan"),
        }

    # End Experiment: closing switches the bridge off. Builder: `display.close()`.

    def end_experiment(self) -> None:
        self.display.hold(NEUTRAL_C, 2.0)


def frames_of_psychopy(window: Any) -> Callable[[], None]:
    """Each call is a frame; Escape ends the experiment, with the bridge off."""
    circle = visual.Circle(window, radius=0.1, fillColor="white")

    def frame() -> None:
        circle.draw()
        window.flip()
        if event.getKeys(["escape"]):
            raise KeyboardInterrupt

    return frame


def plain_frame() -> None:
    """A frame without PsychoPy."""
    time.sleep(FRAME_S)


def main() -> None:
    parser = argparse.ArgumentParser(description="Warm and cold cues, with or without PsychoPy.")
    parser.add_argument("--port", help="serial port of the device; without it the device is simulated")
    parser.add_argument("--trials", type=int, default=4)
    arguments = parser.parse_args()
    display = Display.open(arguments.port) if arguments.port else Display.simulated()
    # PsychoPy ends by core.quit() or an exception; in both cases the block switches the bridge off.
    with display:
        window = None if visual is None else visual.Window(fullscr=False, units="height")
        frame = plain_frame if window is None else frames_of_psychopy(window)
        cue = Cue(display)
        cue.begin_experiment()
        random = np.random.default_rng(1)
        for trial in range(arguments.trials):
            change_k = float(random.choice([-6.0, 3.0]))
            cue.begin_routine(change_k)
            while cue.each_frame():
                frame()
            result = cue.end_routine()
            print(
                f"trial {trial}: {change_k:+.0f} K, {result['cue_offset_s'] - result['cue_onset_s']:.3f} s, "
                f"display {result['display_min_c']:.2f} to {result['display_max_c']:.2f} C, lost {result['lost']:.0f}"
            )
        cue.end_experiment()
        if window is not None:
            window.close()
    if core is not None:
        core.quit()


if __name__ == "__main__":
    try:
        main()
    except DisplayError as error:
        raise SystemExit(f"psychopy_cue: {error}") from error
    except KeyboardInterrupt:
        raise SystemExit("psychopy_cue: ended by Escape or Ctrl-C; the bridge is off") from None
