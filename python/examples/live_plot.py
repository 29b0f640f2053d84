"""Plots set-point and display while telemetry streams; needs matplotlib beside this package.

    python live_plot.py                       # a simulated device that plays pulses
    python live_plot.py --port /dev/ttyACM0   # whatever the device does
"""

from __future__ import annotations

import argparse

import matplotlib.pyplot as plt
import numpy as np

from thermal_display import TELEMETRY_DTYPE, Display

SHOWN_S = 20.0


def main() -> None:
    parser = argparse.ArgumentParser(description="Plots telemetry live.")
    parser.add_argument("--port", help="serial port of the device; without it the device is simulated")
    arguments = parser.parse_args()
    with Display.open(arguments.port) if arguments.port else Display.simulated() as display:
        if not arguments.port:
            display.arm(wait_s=10)
            display.pulse(33, 27, 3, 2, 3, repeats=1000)
        figure, axes = plt.subplots()
        curves = {name: axes.plot([], [], label=name)[0] for name in ("setpoint_c", "display_c", "skin_c")}
        axes.set(xlabel="device time, s", ylabel="temperature, °C", ylim=(15, 42))
        axes.legend(loc="upper right")
        rows = np.zeros(0, TELEMETRY_DTYPE)
        while plt.fignum_exists(figure.number):
            display.check()
            rows = np.concatenate([rows, display.telemetry.take()])
            if len(rows):
                t_s = rows["tick"] * 1e-3
                rows = rows[t_s > t_s[-1] - SHOWN_S]
                t_s = rows["tick"] * 1e-3
                for name, curve in curves.items():
                    curve.set_data(t_s, rows[name])
                axes.set_xlim(t_s[-1] - SHOWN_S, t_s[-1])
            plt.pause(0.05)


if __name__ == "__main__":
    main()
