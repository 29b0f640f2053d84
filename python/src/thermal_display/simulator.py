"""A simulated device: `hil-sim serve` as a child process."""

from __future__ import annotations

import os
import queue
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import Literal

from . import wire
from .errors import SimulatorMissing

HIL_SIM_VARIABLE = "THERMAL_DISPLAY_HIL_SIM"
"""Environment variable with the path of the program `hil-sim`."""
START_TIMEOUT_S = 60.0
"""Longest wait for a simulated device, s; it is commissioned first, which is computed."""

Speed = Literal["1", "max"]
"""Real time, or as fast as it goes."""

# The shell ends the program when its standard input ends, which it does however this process ends. Its own output is closed, so
# that the end of the program's output shows that it has ended.
_ENDS_WITH_PARENT = '"$@" </dev/null & program=$!; exec >/dev/null 2>&1; cat; kill $program; wait $program'


def find_hil_sim(hil_sim: str | os.PathLike[str] | None = None) -> str:
    """Path of the program: the argument, else the environment variable, else the search path."""
    chosen, by = (
        (hil_sim, "hil_sim") if hil_sim is not None else (os.environ.get(HIL_SIM_VARIABLE), HIL_SIM_VARIABLE)
    )
    if chosen is None:
        chosen, by = "hil-sim", "the search path"
    found = shutil.which(os.fspath(chosen))
    if found is None:
        raise SimulatorMissing(
            f"the program '{os.fspath(chosen)}' ({by}) is not there or cannot be run. Build it with "
            "`cargo build --release -p hil-sim --no-default-features`, and name target/release/hil-sim by the "
            f"argument hil_sim or by the environment variable {HIL_SIM_VARIABLE}"
        )
    return found


class Simulator:
    """A served device. It ends with `stop`, or with this process."""

    def __init__(
        self,
        hil_sim: str | os.PathLike[str] | None = None,
        scene: str | os.PathLike[str] | None = None,
        fingers: Literal[1, 5] = 1,
        speed: Speed = "1",
        surroundings: bool = False,
        commissioned: bool = True,
    ) -> None:
        command = [find_hil_sim(hil_sim), "serve"]
        if scene is not None:
            if not Path(scene).is_file():
                raise FileNotFoundError(f"the scene {os.fspath(scene)} is not there")
            command.append(os.fspath(scene))
        command += ["--engine", "native", "--tcp", "127.0.0.1:0", "--fingers", str(fingers), "--speed", speed]
        if surroundings:
            command += ["--surroundings", "127.0.0.1:0"]
        if commissioned:
            command.append("--commissioned")
        if os.name == "posix":
            command = ["sh", "-c", _ENDS_WITH_PARENT, "sh", *command]
        self._errors = tempfile.TemporaryFile()
        self._child = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
            # Ctrl-C is for this process, which still needs the device to switch its bridge off.
            start_new_session=True,
        )
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        threading.Thread(target=self._read_lines, name="hil-sim output", daemon=True).start()
        self.surroundings_address: str | None = None
        """Where the surroundings are, as HOST:PORT."""
        try:
            self.address: str = self._place("listening on ")
            """Where the device is, as HOST:PORT."""
            if surroundings:
                self.surroundings_address = self._place("surroundings on ")
                # Time stands still until somebody has been there.
                self.surroundings("wait 1 0")
        except BaseException:
            self.stop()
            raise

    def _read_lines(self) -> None:
        assert self._child.stdout is not None
        for line in self._child.stdout:
            self._lines.put(line)
        self._lines.put("")

    def _place(self, begin: str) -> str:
        try:
            line = self._lines.get(timeout=START_TIMEOUT_S)
        except queue.Empty:
            raise SimulatorMissing(f"hil-sim did not start within {START_TIMEOUT_S:g} s") from None
        if not line.startswith(begin):
            self._errors.seek(0)
            said = self._errors.read().decode("utf-8", "replace").strip()
            raise SimulatorMissing(f"hil-sim did not start: {line.strip()}{said}")
        return line.removeprefix(begin).strip()

    def surroundings(self, *lines: str) -> list[str]:
        """Sends lines to what is around the device; returns what follows `ok`. While they are executed the device's time
        stands still; then it goes on. Needs `surroundings=True`."""
        if self.surroundings_address is None:
            raise ValueError("surroundings=True starts a device with surroundings")
        host, _, port = self.surroundings_address.rpartition(":")
        answers = []
        with socket.create_connection((host, int(port)), 5.0) as connection:
            connection.settimeout(10.0)
            with connection.makefile("rw", encoding="ascii", newline="\n") as stream:
                for line in lines:
                    stream.write(line + "\n")
                    stream.flush()
                    answer = stream.readline().strip()
                    if answer.split(" ", 1)[0] != "ok":
                        raise ValueError(f"hil-sim answers '{line}' with '{wire.escaped(answer)}'")
                    answers.append(answer.removeprefix("ok").strip())
        return answers

    def press(self, force_n: float) -> None:
        """The finger presses with a force, N, until it presses with another one; 0 lifts it."""
        self.surroundings(f"force {force_n:g}")

    def stop(self) -> None:
        """Ends the program."""
        if self._child.stdin is not None:
            self._child.stdin.close()
        if os.name != "posix":
            self._child.terminate()
        try:
            self._child.wait(10.0)
        except subprocess.TimeoutExpired:
            print("hil-sim does not end and is killed", file=sys.stderr)
            self._child.kill()
            self._child.wait()
        self._errors.close()
