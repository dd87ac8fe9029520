"""One headless run of a study and the figures that Table 5.1 has of it."""

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.metrics import Metrics, compute_metrics
from ddct_controllers.interface import Controller
from ddct_plant.program.table import text_or_dash
from ddct_plant.scenario.settings import RunSettings

FIGURE_HEADERS = ('t_a s', 'std w_sr rpm', 'std A_x m/s^2')


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


def figures(metrics: Metrics) -> tuple[str, str, str]:
    """Return the cells below FIGURE_HEADERS; a dash for what is undefined."""
    return (
        text_or_dash(metrics.engagement_time_s, '.3f'),
        text_or_dash(metrics.torsion_speed_std_rpm, '.2f'),
        text_or_dash(metrics.acceleration_std_m_s2, '.3f'),
    )
