# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of one step of `least_jerk` beside `mpc3`, each with the measurements of its own run."""

from collections.abc import Callable, Iterator, Mapping

from bench.comparisons.mpc_step import update_times
from bench.peers.replay import measurements_of
from bench.skeleton.comparison import Bench, Comparison, Sides, comparison

from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

CLUTCH = 'stick_slip'


def _beside_mpc3(scenario: str) -> Comparison:
    @comparison(f'least_jerk in {scenario}, update', 'mpc3', at_most={'median': 2.0})
    def sides(bench: Bench) -> Iterator[Sides]:
        """Wall time of an update."""
        yield Sides(_updates('least_jerk', scenario), _updates('mpc3', scenario))

    return sides


def _updates(name: str, scenario: str) -> Callable[[], Mapping[str, float]]:
    """Return a function that measures the updates of a controller in a scenario once."""
    settings = RunSettings(load_scenario(scenario, clutch=CLUTCH), clutch=CLUTCH)
    controller = make_controller(name, settings)
    measurements = measurements_of(settings, controller)
    return lambda: update_times(controller, measurements)


STEPS = tuple(map(_beside_mpc3, ('launch', 'upshift')))
