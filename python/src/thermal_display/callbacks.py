"""The thread in which callbacks of the user run."""

from __future__ import annotations

import logging
import queue
import threading
from collections.abc import Callable
from typing import Any, TypeVar

log = logging.getLogger("thermal_display")

Occurrence = TypeVar("Occurrence")


class Callbacks:
    """Calls functions of the user for what occurs, one after the other, in a thread of its own: a callback in the thread that
    reads the line could not wait for an answer. The thread begins with the first subscription."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._subscribed: list[tuple[type, Callable[[Any], None]]] = []
        self._queue: queue.SimpleQueue[object] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None

    def subscribe(
        self, of: type[Occurrence], callback: Callable[[Occurrence], None]
    ) -> Callable[[], None]:
        """Calls `callback` for what occurs of a type; returns a function that ends this."""
        entry = (of, callback)
        with self._lock:
            self._subscribed.append(entry)
            if self._thread is None:
                self._thread = threading.Thread(
                    target=self._run, name="thermal-display callbacks", daemon=True
                )
                self._thread.start()

        def unsubscribe() -> None:
            with self._lock:
                if entry in self._subscribed:
                    self._subscribed.remove(entry)

        return unsubscribe

    def occurred(self, occurrence: object) -> None:
        """Hands something that occurred to the thread."""
        if self._thread is not None:
            self._queue.put(occurrence)

    def close(self) -> None:
        """Ends the thread after what has occurred so far."""
        self._queue.put(None)

    def _run(self) -> None:
        while True:
            occurrence = self._queue.get()
            if occurrence is None:
                return
            with self._lock:
                callbacks = [callback for of, callback in self._subscribed if isinstance(occurrence, of)]
            for callback in callbacks:
                try:
                    callback(occurrence)
                except Exception:
                    # The next callback runs all the same; nobody waits for this one.
                    log.exception("callback for %s failed", occurrence)
