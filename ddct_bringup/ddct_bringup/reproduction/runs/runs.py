"""Closed-loop runs of the thesis's scenario, each simulated once however many figures show it."""

from functools import cache

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.metrics import Metrics, compute_metrics
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

THESIS_SCENARIO = load_scenario('thesis')


@cache
def thesis_run(controller: str, architecture: str, wear_gain: float) -> Trajectory:
    """Return the headless run of a controller of the registry."""
    settings = RunSettings(THESIS_SCENARIO, architecture, wear_gain=wear_gain)
    return run_headless(settings, controller)


def thesis_metrics(trajectory: Trajectory) -> Metrics:
    """Return the metrics of such a run."""
    return compute_metrics(
        trajectory,
        control_start_s=THESIS_SCENARIO.control_start_s,
        score_window_s=THESIS_SCENARIO.score_window_s,
    )
