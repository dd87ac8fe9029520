# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Arguments of `run`, `compare` and `sweep` as controllers, settings and plans."""

import warnings
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.processes.graph_names import GraphNames
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.run_base import RunBase
from ddct_controllers.from_python import chosen_from
from ddct_controllers.registry import (
    Chosen,
    controller_label,
    controller_names,
    working_controllers,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import require_known
from ddct_plant.scenario.choices.scenarios import Choice
from ddct_plant.scenario.choices.settings import SETTINGS
from ddct_plant.scenario.content import flat
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.scenario import Scenario
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


def planned(
    controllers: Iterable[Any] | Mapping[str, Any] | str | None,
    layout: str,
    complain: Callable[[str], None],
    names: GraphNames | None = None,
    **options: Any,
) -> list[RunPlan]:
    """
    Return a plan for each controller, given as for `compare`, all with the same options of `run`.

    None is every controller that can be built here; `complain` gets a line for each other one.
    `names` are those of each graph in ROS.
    """
    chosen = controllers_from(controller_names() if controllers is None else controllers)
    settings = run_settings([controller_label(each) for each in chosen], **options)
    if controllers is None:
        chosen = [*working_controllers(settings.known, complain)]
    return [RunPlan(settings, each, layout, names or GraphNames()) for each in chosen]


def run_settings(labels: Iterable[str], *options: Any, **given: Any) -> RunSettings:
    """Return the settings of one run, or of runs, with the controllers called `labels`."""
    return base_from(labels, *options, **given).at()


def warn_of_adjusted(scenario: Scenario) -> None:
    """Warn the caller of the caller of values that moved with those that were set."""
    for line in scenario.adjusted:
        warnings.warn(f'scenario {scenario.name}: {line}', stacklevel=3)


def base_from(
    labels: Iterable[str],
    scenario: str | Path | None = None,
    set: Mapping[str, Any] | None = None,
    duration: float | None = None,
    case: Mapping[str, Any] | None = None,
    *,
    car: str | Path | None = None,
    drive: str | Path | None = None,
    **given: Any,
) -> RunBase:
    """Return the common base of runs with the controllers called `labels`."""
    for name, values in (('set', set), ('case', case)):
        if not isinstance(values, Mapping | None):
            raise ParameterError(
                f"{name} is {values!r}: give keys and values, as {{'load.slope_rad': 0.05}}",
                key=name,
            )
    changes = dict(set or {}) if duration is None else {**(set or {}), 'duration_s': duration}
    require_known(sorted(given), SETTINGS, 'option')
    return RunBase(
        ScenarioFile.read(Choice(_text(scenario), _text(car), _text(drive))),
        {key: plain(changes[key]) for key in changes},
        {key: plain(given[key]) for key in given},
        tuple(labels),
        {key: plain(value) for key, value in flat(case or {}).items()},
    )


def _text(chosen: str | Path | None) -> str | None:
    return None if chosen is None else str(chosen)


def plain(value: Any) -> Any:
    """Return a number or list of numpy as Python's, which bags write as the same text."""
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value
