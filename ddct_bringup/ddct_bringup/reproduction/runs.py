"""Closed-loop runs and their scores; those of the thesis's scenario are simulated once."""

from functools import cache
from typing import Any

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.metrics import Metrics, compute_metrics
from ddct_bringup.thesis.table_5_1 import FIGURES
from ddct_controllers.interface import Command, Controller, Measurement
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
    return metrics_of(RunSettings(THESIS_SCENARIO), trajectory)


def metrics_of(settings: RunSettings, trajectory: Trajectory) -> Metrics:
    """Return the metrics of a run in its scenario's score window."""
    return compute_metrics(
        trajectory,
        control_start_s=settings.scenario.control_start_s,
        score_window_s=settings.scenario.score_window_s,
    )


def scored_run(settings: RunSettings, controller: str | Controller) -> Metrics:
    """Run a controller headless and return its metrics."""
    return metrics_of(settings, run_headless(settings, controller))


def table_figures(metrics: Metrics) -> dict[str, Any]:
    """Return the three figures that Table 5.1 has of a run by name; None for an undefined one."""
    return {name: getattr(metrics, name) for name in FIGURES}


class StaticControllerAlone(Controller):
    """The static controller (Figure 1.17) alone: C_fOL on the clutch, the driver's demand."""

    def reset(self) -> None:
        """There is nothing to forget."""

    def update(self, measurement: Measurement) -> Command:
        """Return no torque."""
        return Command(0.0)
