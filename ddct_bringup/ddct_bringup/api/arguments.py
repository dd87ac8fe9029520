# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Arguments of `run`, `compare` and `sweep` as controllers, settings and metrics."""

import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.run.run_base import RunBase
from ddct_controllers.from_python import chosen_from
from ddct_controllers.registry import (
    Chosen,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import options_of, require_known
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.settings import RunSettings


def controllers_from(controllers: str | Iterable[Any] | Mapping[str, Any]) -> list[Chosen]:
    """
    Return controllers, given as for `compare`, as the registry accepts them.

    Raise ParameterError for none.
    """
    if isinstance(controllers, str):
        controllers = [name.strip() for name in controllers.split(',') if name.strip()]
    if isinstance(controllers, Mapping):
        chosen = [chosen_from(each, name) for name, each in controllers.items()]
    else:
        chosen = [chosen_from(each) for each in controllers]
    if not chosen:
        raise ParameterError('controllers is empty: name at least one', key='controllers')
    return chosen


def ready_settings(labels: list[str], *options: Any, **given: Any) -> RunSettings:
    """Return the settings of one run, or of runs, with the controllers called `labels`."""
    settings = base_from(labels, *options, **given).at()
    for line in settings.scenario.adjusted:
        warnings.warn(f'scenario {settings.scenario.name}: {line}', stacklevel=3)
    return settings


def base_from(
    labels: Iterable[str],
    scenario: str | Path = 'thesis',
    set: Mapping[str, Any] | None = None,
    duration: float | None = None,
    **given: Any,
) -> RunBase:
    """Return the common base of runs with the controllers called `labels`."""
    if not isinstance(set, Mapping | None):
        raise ParameterError(
            f"set is {set!r}: give keys and values, as {{'load.slope_rad': 0.05}}", key='set'
        )
    changes = dict(set or {}) if duration is None else {**(set or {}), 'duration_s': duration}
    require_known(sorted(given), options_of(RunSettings), 'option')
    return RunBase(
        ScenarioFile.read(str(scenario)),
        {key: plain(changes[key]) for key in changes},
        {key: plain(given[key]) for key in given},
        tuple(labels),
    )


def plain(value: Any) -> Any:
    """Return a number or list of numpy as Python's, which bags write as the same text."""
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value
