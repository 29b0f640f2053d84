"""Device ticks against the clock of the host, `time.perf_counter()`.

A line arrives later than the tick that it names, by the time on the line and by delays of USB and operating system, which are
irregular but never negative. So the earliest arrival of each span of time counts, and a line through these, with the median of the
slopes of all pairs, gives offset and drift of the device's clock. A delay that all lines have cannot be seen from one end: it
stays in the estimate. The client in Rust (`lab/client/`) estimates in the same way.
"""

from __future__ import annotations

import statistics
import threading
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

TICK_S = 1e-3
_WRAP = 1 << 32
_SPAN_S = 0.5
"""Length of a span at first, s."""
_SPANS_MAX = 64
"""Spans that are kept; then two become one of twice the length."""
_DIFFERENCE_MAX_TICKS = 200.0
"""By how much a tick may differ from what has passed since the latest one: lines are late, and those of several fingers
overtake each other."""
_RATE_TOLERANCE = 0.03
"""By how much the rates of two clocks may differ; the device's internal oscillator has 1 %."""


@dataclass(frozen=True)
class ClockEstimate:
    """How the device's clock runs."""

    error_s: float
    """Largest distance of the earliest arrivals from the estimate, s."""
    drift_ppm: float
    """By how much the device's clock is slower than the host's, parts in a million."""
    restarts: int
    """Restarts of the device that its ticks have shown."""


def _ticks_since(tick: int, before: int) -> int:
    """Ticks from `before` on; negative if they go back."""
    passed = (tick - before) % _WRAP
    return passed - _WRAP if passed >= _WRAP // 2 else passed


def _in_time(minima: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """The minima that are less late than the rates of two clocks allow, by all others. Where all lines of a span were late, as those
    that have waited while the computer slept, they say nothing of the ticks."""
    return [
        (t_s, late_s)
        for t_s, late_s in minima
        if all(late_s - other_late_s <= _RATE_TOLERANCE * abs(t_s - other_s) for other_s, other_late_s in minima)
    ]


class DeviceClock:
    """Estimate of when ticks happen by the host's clock. It begins anew when the device restarts."""

    def __init__(self, real_time: bool = True) -> None:
        self._lock = threading.Lock()
        self._real_time = real_time
        self._restarts = 0
        self._forget()

    def _forget(self) -> None:
        self._latest: tuple[int, float] | None = None
        self._wrapped = 0
        self._doubted: tuple[int, float] | None = None
        self._span_s = _SPAN_S
        # Of each span the earliest arrival: time by ticks, s, and how much later by the host's clock it arrived, s.
        self._minima: list[tuple[float, float]] = []
        self._fit: tuple[float, float, float, float] | None = None

    def restart(self) -> None:
        """Forgets the estimate: the device has restarted."""
        with self._lock:
            self._restarts += 1
            self._forget()

    def observe(self, tick: int, at_s: float) -> None:
        """Takes note of a line that names a tick and arrived at a time."""
        with self._lock:
            latest = self._latest
            if latest is not None and not self._follows(tick, at_s, latest):
                # Without checksums a damaged digit passes for a tick, so one such line does not count.
                doubted, self._doubted = self._doubted, (tick, at_s)
                if doubted is None or not self._follows(tick, at_s, doubted):
                    return
                # Ticks that jump ahead are of no restart: those before were wrong.
                self._restarts += _ticks_since(tick, latest[0]) < 0
                self._forget()
                self._add(*doubted)
            self._doubted = None
            self._add(tick, at_s)

    def _follows(self, tick: int, at_s: float, before: tuple[int, float]) -> bool:
        """Whether one run of the device can have sent both."""
        ticks = _ticks_since(tick, before[0])
        if not self._real_time:
            return ticks >= -_DIFFERENCE_MAX_TICKS
        passed = max(0.0, at_s - before[1]) / TICK_S
        return -_DIFFERENCE_MAX_TICKS <= ticks <= passed * (1 + _RATE_TOLERANCE) + _DIFFERENCE_MAX_TICKS

    def _add(self, tick: int, at_s: float) -> None:
        latest = self._latest
        if latest is None or _ticks_since(tick, latest[0]) >= 0:
            if latest is not None and tick < latest[0]:
                self._wrapped += _WRAP
            self._latest = (tick, at_s)
        tick_s = self._tick_s(tick)
        late_s = at_s - tick_s
        minima = self._minima
        if minima and minima[-1][0] // self._span_s >= tick_s // self._span_s:
            if late_s < minima[-1][1]:
                minima[-1] = (tick_s, late_s)
                if len(minima) < 3:
                    self._fit = None
        else:
            minima.append((tick_s, late_s))
            self._fit = None
        if len(minima) > _SPANS_MAX:
            self._span_s *= 2
            merged: list[tuple[float, float]] = []
            for one in minima:
                if merged and merged[-1][0] // self._span_s == one[0] // self._span_s:
                    merged[-1] = min(merged[-1], one, key=lambda minimum: minimum[1])
                else:
                    merged.append(one)
            self._minima = merged

    def _tick_s(self, tick: int) -> float:
        """Time of a tick since the device's reset, s, also beyond the 32 bits of the ticks."""
        latest = self._latest
        before_wrap = latest is not None and tick > latest[0] and _ticks_since(tick, latest[0]) < 0
        return (tick + self._wrapped - (_WRAP if before_wrap and self._wrapped else 0)) * TICK_S

    def _line(self) -> tuple[float, float, float, float] | None:
        """Time of the last span, offset there, drift and error. Kept until a span begins: the slopes of 64 spans take
        milliseconds, and lines come every millisecond."""
        if self._fit is None and self._minima:
            last_s = self._minima[-1][0]
            # The span that is not complete has not seen its earliest arrival yet.
            complete = self._minima[:-1] if len(self._minima) >= 3 else self._minima
            in_time = _in_time(complete)
            slopes = [
                (b[1] - a[1]) / (b[0] - a[0]) for i, a in enumerate(in_time) for b in in_time[i + 1 :]
            ]
            # Two spans alone say little of a drift of some parts in a million.
            drift = statistics.median(slopes) if len(in_time) >= 3 else 0.0
            offsets = [late_s - drift * (t_s - last_s) for t_s, late_s in in_time]
            offset_s = statistics.median(offsets) if len(in_time) >= 3 else min(offsets)
            error_s = max(abs(one - offset_s) for one in offsets)
            self._fit = (last_s, offset_s, drift, error_s)
        return self._fit

    def time_of(self, tick: int) -> float:
        """When a tick since the last restart happened, s of `time.perf_counter()`; NaN before the first line with a tick."""
        with self._lock:
            line = self._line()
            if line is None:
                return float("nan")
            last_s, offset_s, drift, _ = line
            tick_s = self._tick_s(tick)
            return tick_s + offset_s + drift * (tick_s - last_s)

    def times_of(self, ticks: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """When ticks since the last restart happened, from all lines so far: better than what could be said when they arrived."""
        flat = np.atleast_1d(np.asarray(ticks, dtype=np.int64))
        with self._lock:
            line = self._line()
            if line is None:
                return np.full(flat.shape, np.nan)
            last_s, offset_s, drift, _ = line
            latest = self._latest[0] if self._latest else 0
            # As `_tick_s`, for all at once.
            before_wrap = (flat > latest) & ((flat - latest) % _WRAP >= _WRAP // 2) & (self._wrapped > 0)
            tick_s = (flat + self._wrapped - before_wrap * _WRAP) * TICK_S
        times: npt.NDArray[np.float64] = tick_s + offset_s + drift * (tick_s - last_s)
        return times

    @property
    def estimate(self) -> ClockEstimate:
        """Error, drift and restarts."""
        with self._lock:
            line = self._line()
            if line is None:
                return ClockEstimate(float("nan"), float("nan"), self._restarts)
            return ClockEstimate(line[3], 1e6 * line[2], self._restarts)
