# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A sweep as the specification of a campaign with the same runs."""

from pathlib import Path
from typing import Any

from ddct_bringup.campaign.keys import CONTROLLERS, HANDOVER, run_options
from ddct_bringup.campaign.rows import SEED
from ddct_bringup.campaign.specification.parts import GRID, KNOWN
from ddct_bringup.sweep.sweep import Sweep
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_plant.scenario.choices.scenarios import is_packaged

_ARCHITECTURE = 'architecture'


def specification_of(sweep: Sweep) -> dict[str, Any]:
    """
    Return the specification of a campaign with the runs of a sweep of named controllers.

    Values for all runs that no key of a specification gives are on its grid with one value each.
    Paths are absolute.
    """
    base, options = sweep.base, run_options()
    axes = {axis.key: list(axis.values) for axis in sweep.axes}
    settings = {
        key: base.settings[key]
        for key in options
        if key in base.settings and base.settings[key] != options[key].default
    }
    if sweep.first.scenario.sensors is not None:
        settings.setdefault(SEED, sweep.first.case.seed)  # else each case has its own
    common = {
        key: name if is_packaged(name) else _path(name)
        for key, name in base.file.choice.given.items()
    }
    if _ARCHITECTURE in settings:
        common[_ARCHITECTURE] = settings.pop(_ARCHITECTURE)
    if str(settings.get(HANDOVER, '')).endswith('.py'):
        settings[HANDOVER] = _path(settings[HANDOVER])
    constant = {**settings, **base.changes, **base.case}
    known = [key for key in base.changes if key not in axes]
    return {
        CONTROLLERS: [
            _path(each) if is_controller_file(each) else each
            for each in map(str, sweep.controllers)
        ],
        **{key: name for key, name in common.items() if key not in axes},
        GRID: {**{key: [constant[key]] for key in constant if key not in axes}, **axes},
        **({KNOWN: known} if known else {}),
    }


def _path(name: str) -> str:
    return str(Path(name).absolute())
