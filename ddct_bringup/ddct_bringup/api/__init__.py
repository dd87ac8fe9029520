# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The stable interface for scripts and notebooks: run, judge, tabulate and draw; docs/use/python.md.

The shortest example::

    from ddct_bringup.api import run
    print(run('pi', wear_gain=0.7).metrics['engagement_time_s'])

Arguments have the names of the options of `ddct bringup`. An invalid one raises `DdctError` or its
subclass `ParameterError`. Nothing is printed; scenario values that were adjusted give a warning.

The module of a name is imported when the name is first used: to import this package is cheap, and
`run` does not wait for what draws or tunes.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ddct_bringup.api.benchmarks import BenchmarkResults, benchmark
    from ddct_bringup.api.campaigns import CampaignResults, campaign, read_campaign, sweep
    from ddct_bringup.api.figures import ThesisDrawing, campaign_figure, figure, thesis_figure
    from ddct_bringup.api.result import Run, table
    from ddct_bringup.api.run_and_load import compare, load, run
    from ddct_bringup.api.thesis import ThesisNumbers, beside_thesis, table_5_2, thesis_numbers
    from ddct_bringup.api.tuning import TuningResults, tune
    from ddct_bringup.scores.document import read_scores
    from ddct_bringup.scores.scored_run import ScoredRun
    from ddct_controllers.interface import Command, Controller, ControllerContext, Measurement
    from ddct_controllers.registry import controller_names
    from ddct_plant.base.errors import DdctError, ParameterError
    from ddct_plant.base.options import Option
    from ddct_plant.scenario.choices.scenarios import scenario_names

__all__ = [
    'BenchmarkResults',
    'CampaignResults',
    'Command',
    'Controller',
    'ControllerContext',
    'DdctError',
    'Measurement',
    'Option',
    'ParameterError',
    'Run',
    'ScoredRun',
    'ThesisDrawing',
    'ThesisNumbers',
    'TuningResults',
    'benchmark',
    'beside_thesis',
    'campaign',
    'campaign_figure',
    'compare',
    'controller_names',
    'figure',
    'load',
    'read_campaign',
    'read_scores',
    'run',
    'scenario_names',
    'sweep',
    'table',
    'table_5_2',
    'thesis_figure',
    'thesis_numbers',
    'tune',
]

_NAMES = {
    'ddct_bringup.api.benchmarks': ('BenchmarkResults', 'benchmark'),
    'ddct_bringup.api.campaigns': ('CampaignResults', 'campaign', 'read_campaign', 'sweep'),
    'ddct_bringup.api.figures': ('ThesisDrawing', 'campaign_figure', 'figure', 'thesis_figure'),
    'ddct_bringup.api.result': ('Run', 'table'),
    'ddct_bringup.api.run_and_load': ('compare', 'load', 'run'),
    'ddct_bringup.api.thesis': ('ThesisNumbers', 'beside_thesis', 'table_5_2', 'thesis_numbers'),
    'ddct_bringup.api.tuning': ('TuningResults', 'tune'),
    'ddct_bringup.scores.document': ('read_scores',),
    'ddct_bringup.scores.scored_run': ('ScoredRun',),
    'ddct_controllers.interface': ('Command', 'Controller', 'ControllerContext', 'Measurement'),
    'ddct_controllers.registry': ('controller_names',),
    'ddct_plant.base.errors': ('DdctError', 'ParameterError'),
    'ddct_plant.base.options': ('Option',),
    'ddct_plant.scenario.choices.scenarios': ('scenario_names',),
}
"""Names of this package by their module, the same as type checkers read above."""
_MODULE_OF = {name: module for module, names in _NAMES.items() for name in names}


def __getattr__(name: str) -> Any:
    """Import the module of a name at its first use, and keep the name here."""
    if name not in _MODULE_OF:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}', name=name)
    found = getattr(import_module(_MODULE_OF[name]), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    """Return the names of the package, also those that were not used yet."""
    return sorted({*globals(), *__all__})
