# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controller files of the trials on the front, which every program takes at once."""

import os
import re
from collections.abc import Sequence
from pathlib import Path

from ddct_bringup.tuning.trial import Trial
from ddct_bringup.tuning.tuned_names import BEST, FRONT_FOLDER
from ddct_bringup.tuning.tuning import Tuning
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.from_file.with_options import with_options_text
from ddct_plant.files.output_file import write_text

_LONGEST = 24
"""Largest number of characters of the controller's name in that of a trial."""


def trial_file(number: int) -> str:
    """Return the path of the controller file of a trial, within the folder of the tuning."""
    return f'{FRONT_FOLDER}/trial_{number:04d}.yaml'


def tuned_files(tuning: Tuning, out: Path, trials: Sequence[Trial], best: Trial) -> dict[str, str]:
    """
    Return the texts of the controller files by their path within the folder of the tuning.

    That of the best trial is there once more as BEST.
    """
    front = out / FRONT_FOLDER
    files = {
        trial_file(each.number): _text(tuning, front, each, trial_name(tuning, each))
        for each in trials
    }
    return {**files, BEST: _text(tuning, out, best, _name(tuning, 'tuned'))}


def write_tuned_files(tuning: Tuning, out: Path, trials: Sequence[Trial], best: Trial) -> None:
    """Write the controller files; raise DdctError when that fails."""
    (out / FRONT_FOLDER).mkdir(exist_ok=True)
    for name, text in tuned_files(tuning, out, trials, best).items():
        write_text(str(out / name), text)


def trial_name(tuning: Tuning, trial: Trial) -> str:
    """Return the name of the controller in the file of a trial."""
    return _name(tuning, f'trial_{trial.number:04d}')


def _name(tuning: Tuning, ending: str) -> str:
    base = re.sub(r'[^a-z0-9_]', '_', tuning.controller.name.lower())[:_LONGEST].strip('_')
    return f'{base if base[:1].isalpha() else "controller"}_{ending}'


def _text(tuning: Tuning, folder: Path, trial: Trial, name: str) -> str:
    chosen = tuning.judged.path
    if is_controller_file(chosen):
        chosen = os.path.relpath(chosen, folder)
    options = {**tuning.untuned, **trial.values}
    return with_options_text(name, chosen, options)
