# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The stable interface for scripts and notebooks: run, judge, tabulate and draw; docs/use/python.md.

The shortest example::

    from ddct_bringup.api import run
    print(run('pi', wear_gain=0.7).metrics['engagement_time_s'])

Arguments have the names of the options of `ddct compare`. An invalid one raises `DdctError` or its
subclass `ParameterError`. Nothing is printed; scenario values that were adjusted give a warning.

The module of a name is imported when the name is first used: to import this package is cheap, and
`run` does not wait for what draws or tunes.
"""

from typing import TYPE_CHECKING

from ddct_plant.base.late_names import late_names

if TYPE_CHECKING:
    from ddct_bringup.api.benchmarks import BenchmarkResults, benchmark
    from ddct_bringup.api.campaigns import CampaignResults, campaign, read_campaign, sweep
    from ddct_bringup.api.documents import document
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
    from ddct_plant.scenario.choices.scenarios import car_names, drive_names, scenario_names
else:
    __getattr__, __dir__, __all__ = late_names(__name__)
