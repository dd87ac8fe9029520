"""One headless run of a study and the figures that Table 5.1 has of it."""

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.headless import run_headless
from ddct_bringup.scores.metrics import Metrics, compute_metrics
from ddct_controllers.interface import Controller
from ddct_plant.run_settings import RunSettings

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
        text(metrics.engagement_time_s, '.3f'),
        text(metrics.torsion_speed_std_rpm, '.2f'),
        text(metrics.acceleration_std_m_s2, '.3f'),
    )


def text(value: float | None, form: str) -> str:
    """Return a number in a format, or a dash for None."""
    return '-' if value is None else format(value, form)
