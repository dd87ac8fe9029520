# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""State at control start of a scenario, simulated once for all runs that start alike."""

from ddct_bringup.floor.dynamics.propagators import WHEEL
from ddct_bringup.floor.dynamics.start import Start, start_of
from ddct_bringup.run.headless import run_loop
from ddct_controllers.interface import Controller
from ddct_controllers.loop import ClosedLoop
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.settings import RunSettings

_DRIVER = 'pi'
"""Controller of the run to control start, where every controller of `detailed` is the same."""
_MOST_KEPT = 16
_kept: list[tuple[RunSettings, Start]] = []
"""States of the last settings, the newest last."""


def control_start(settings: RunSettings) -> Start:
    """
    Return the state at control start, which every controller of the architecture starts from.

    In a gear shift it is that at the start of the inertia phase: until then the requests are those
    of the handover. Raise ParameterError where it depends on the controller, or where the plates
    do not slip there or the wheels do not turn forward.
    """
    if not settings.detailed:
        raise ParameterError(
            f'architecture {settings.known.architecture}: feedback is on from t = 0, so the state '
            'at control start depends on the controller: choose the architecture detailed',
            key='architecture',
        )
    start = _simulated(settings)
    if settings.stick_slip and start.state[WHEEL] <= 0.0:
        raise ParameterError(
            f'scenario {settings.scenario.name}: the wheels do not turn forward at control start, '
            'and when they break loose depends on the controller: there is no floor'
        )
    if start.slip == 0.0:
        raise ParameterError(
            f'scenario {settings.scenario.name}: the plates do not slip at control start: there '
            'is nothing to engage, and no floor'
        )
    return start


def _simulated(settings: RunSettings) -> Start:
    """Return the state at the end of a run that ends with control start."""
    for known, start in _kept:
        if known == settings:
            return start
    controller = make_controller(_DRIVER, settings.known)
    assert isinstance(controller, Controller)
    scenario = settings.scenario
    # When feedback starts in a shift, and when the off-going clutch is open, the run shows.
    steps = scenario.steps if settings.shift else scenario.control_start_step
    start = start_of(settings, run_loop(ClosedLoop(settings, controller), steps))
    _kept.append((settings, start))
    del _kept[:-_MOST_KEPT]
    return start
