#!/bin/sh
# Guess: a block of gustav's adaptive method runs as long as it is asked to, and its result does not depend on the blocks before it.
#
# Seen, with gustav 0.8.2 on Python 3.11: each block begins with the state in which the one before it ended, except for its values and
# reversals.
# - A staircase that runs into its ceiling has no mean, and `good_run` False ("True if the run finished normally" in the method's
#   comments), if it is the first block. Behind a block that finished, the same answers have `good_run` True and a mean of 3.5 K.
# - A step down takes two correct answers in a row, but one is enough at the start of a block if the one before ended with one.
# - `run_n_trials`, "run exactly this number of trials", runs one more: 9 of 8.
#
# A threshold of a block without one passes for data. In a `pre_block` of the experiment, set `good_run` to False, and `cur_dns`,
# `cur_ups` and the counts of floor and ceiling to 0.
#
# Fails if a level, a mean or `good_run` changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --no-compile --disable-pip-version-check gustav==0.8.2 numpy==2.4.6
cat > staircase.py <<'PYTHON'
import os

# Answers of the participant in each condition: until four reversals, until the ceiling, and until the number of trials, with one correct
# answer at the end.
ANSWERS = {"finished": "110110110", "ceiling": "11011000000", "counted": "110110101"}


def setup(exp):
    exp.name = "staircase"
    exp.method = "adaptive"
    exp.frontend = "term"
    exp.logFile, exp.logConsole = "./staircase.log", False
    exp.dataFile, exp.recordData = "./staircase.txt", False
    exp.validKeys, exp.note, exp.comments = "1,2", "", ""
    exp.var.factorial["condition"] = os.environ["CONDITIONS"].split()
    exp.var.order = "natural"
    exp.var.dynamic = {
        "name": "step", "units": "K", "alternatives": 2, "steps": [1, 1, 1, 1], "downs": 2, "ups": 1, "val_start": 4, "val_floor": 0,
        "val_ceil": 6, "val_floor_n": 3, "val_ceil_n": 3, "run_n_trials": 0, "max_trials": 0, "vals_to_avg": 2,
    }


def pre_trial(exp):
    exp.var.dynamic["correct"] = 1
    exp.var.dynamic["run_n_trials"] = 8 if exp.var.current["condition"] == "counted" else 0


def present_trial(exp):
    pass


def prompt_response(exp):
    exp.run.response = "1" if ANSWERS[exp.var.current["condition"]][exp.run.trials_block] == "1" else "2"


def post_block(exp):
    block = exp.var.dynamic
    print(exp.var.current["condition"], block["values"], block["good_run"], block["mean"], sep="; ")
PYTHON
run() {
    CONDITIONS=$1 env/bin/python -W ignore -c 'import gustav; gustav.run("./staircase.py", subjectID="1")'
}
for conditions in "ceiling finished" "finished ceiling" "counted ceiling"; do
    run "$conditions"
done | tee seen
diff - seen <<'EXPECTED' || { echo CHANGED; exit 1; }
ceiling; [4, 4, 3, 4, 4, 3, 4, 5, 6, 6, 6]; False; nan
finished; [4, 4, 3, 4, 4, 3, 4, 4]; True; 3.5
finished; [4, 4, 3, 4, 4, 3, 4, 4]; True; 3.5
ceiling; [4, 4, 3, 4, 4, 3, 4, 5, 6, 6, 6]; True; 3.5
counted; [4, 4, 3, 4, 4, 3, 4, 4, 5]; True; 3.5
ceiling; [4, 3, 3, 4, 4, 3, 4, 5, 6, 6, 6]; True; 3.5
EXPECTED
