# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The commands that the page of a tuning names, each as a line for a shell."""

import json
import os
import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from ddct_bringup.campaign.keys import run_options
from ddct_bringup.campaign.specification.named_files import placed
from ddct_bringup.tuning.tuned_names import BEST
from ddct_bringup.tuning.tuning import Tuning
from ddct_plant.scenario.choices.scenarios import CHOICES, Choice, is_packaged


@dataclass(frozen=True)
class PageCommands:
    """Commands of a tuning, for a shell in its folder."""

    compare: str
    """Command that runs the best controller, beside that of before where that was tried."""
    further_scenarios: Sequence[str]
    """Scenarios of the cases besides that of `compare`."""
    verify: str
    """Command that computes the tuning again."""

    @classmethod
    def of(cls, tuning: Tuning, out: Path) -> 'PageCommands':
        """Return the commands of a tuning in the folder `out`."""
        values = (_values(tuning, case) for case in tuning.cases)
        chosen = dict.fromkeys(
            ', '.join(str(each[key]) for key in CHOICES if key in each) for each in values
        )
        return cls(_compare(tuning, out), list(chosen)[1:], 'ddct verify .')


def _compare(tuning: Tuning, out: Path) -> str:
    """
    Return the command that runs the best controller, beside that of before, in the first case.

    Numbers that were drawn at random are left out, so that they have their nominal values.
    """
    spec = tuning.campaign.spec
    given = dict(_values(tuning, tuning.cases[0]))
    chosen = Choice.taken_from(given).given
    controllers = [BEST]
    if tuning.present:  # else it may lack a value, and the page has no figures of it
        controllers.insert(0, _in_folder(tuning.judged.path, out))
    words = ['ddct', 'compare', '--controllers', ','.join(controllers)]
    for noun, name in chosen.items():
        file = name if is_packaged(name) else _in_folder(str(spec.folder / name), out)
        words += [f'--{noun}', file]
    for key, value in given.items():
        if key not in spec.vary or type(value) not in (int, float):
            words += _option(key, placed(key, value, partial(_of_spec, spec.folder, out)))
    return shlex.join([*words, '--headless', '--out', '../tuned'])


def _in_folder(chosen: str, out: Path) -> str:
    """Return a name, or the path of a file relative to the folder of the page."""
    return os.path.relpath(chosen, out) if os.sep in chosen else chosen


def _of_spec(folder: Path, out: Path, name: str) -> str:
    return os.path.relpath(folder / name, out)


def _values(tuning: Tuning, case: int) -> Mapping[str, object]:
    """Return the values of a case by key: those of all cases, and those that vary."""
    (varied,) = tuning.campaign.varied(range(case, case + 1))
    return {**tuning.campaign.spec.common, **varied}


def _option(key: str, value: object) -> Iterator[str]:
    """Yield the words of an option of `ddct compare` that gives a key its value."""
    if key in run_options():
        yield from (f'--{key.replace("_", "-")}', str(value))
    else:
        yield from ('--set', f'{key}={json.dumps(value)}')
