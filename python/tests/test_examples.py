"""The examples run as they are printed, on simulated devices."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from pathlib import Path

EXAMPLES = Path(__file__).parents[1] / "examples"


def run(hil_sim: str, name: str, *arguments: str) -> str:
    """What an example prints."""
    # It finds no PsychoPy, wherever it runs.
    hidden = "import sys; sys.modules['psychopy'] = None; import runpy; sys.argv = sys.argv[1:]; "
    ended = subprocess.run(
        [sys.executable, "-c", hidden + "runpy.run_path(sys.argv[0], run_name='__main__')", EXAMPLES / name, *arguments],
        env={**os.environ, "THERMAL_DISPLAY_HIL_SIM": hil_sim},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert ended.returncode == 0, ended.stderr
    assert "was not closed" not in ended.stderr
    return ended.stdout


def test_the_psychopy_example_runs_without_psychopy(hil_sim: str) -> None:
    printed = run(hil_sim, "psychopy_cue.py", "--trials", "1")
    assert printed.startswith("trial 0: ")
    assert "lost 0" in printed
    # The first cue begins at the neutral temperature, and goes 6 K down or 3 K up.
    lowest_c, highest_c = (float(word) for word in printed.split("display ")[1].split(" C")[0].split(" to "))
    assert 26 < lowest_c and highest_c < 37


def test_the_forced_choice_writes_a_row_for_each_trial(hil_sim: str, tmp_path: Path) -> None:
    out = tmp_path / "choice.csv"
    # An observer without noise is right.
    run(hil_sim, "two_interval_choice.py", "--simulated", "--trials", "2", "--observer", "0", "--out", str(out))
    with out.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["trial"] for row in rows] == ["1", "2"]
    assert all(row["answer"] == row["colder_interval"] and row["correct"] == "1" for row in rows)
    assert all(float(row["onset_2_s"]) > float(row["onset_1_s"]) for row in rows)


def test_the_lines_of_the_readme_run(hil_sim: str) -> None:
    readme = (EXAMPLES.parent / "README.md").read_text(encoding="utf-8")
    lines = readme.split("```python\n")[1].split("```")[0]
    ended = subprocess.run(
        [sys.executable, "-c", lines],
        env={**os.environ, "THERMAL_DISPLAY_HIL_SIM": hil_sim},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert (ended.returncode, ended.stderr) == (0, "")


def test_an_example_without_a_simulator_says_what_is_missing() -> None:
    ended = subprocess.run(
        [sys.executable, EXAMPLES / "two_interval_choice.py", "--simulated"],
        env={**os.environ, "THERMAL_DISPLAY_HIL_SIM": "nowhere"},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert ended.returncode == 1
    assert "THERMAL_DISPLAY_HIL_SIM" in ended.stderr and "Traceback" not in ended.stderr
