"""What MPC4 keeps of its advantage as the engine's authority shrinks."""

from collections.abc import Sequence
from dataclasses import replace

from ddct_bringup.reproduction.runs.runs import THESIS_SCENARIO
from ddct_bringup.reproduction.studies.scored_run import metrics_of
from ddct_bringup.reproduction.studies.study import Study
from ddct_bringup.reproduction.studies.two_input.two_input_figures import HEADERS, cells
from ddct_bringup.run.headless import run_headless
from ddct_plant.models.engine import EngineAuthority
from ddct_plant.program.table import text_or_dash
from ddct_plant.scenario.settings import RunSettings

CONTROLLERS = ('mpc4', 'mpc4_wear')
DEVIATIONS_N_M = (40.0, 30.0, 20.0, 10.0, 5.0, 0.0)
SLEWS_N_M_S = (2000.0, 1000.0, 500.0, 200.0, 100.0)
LAGS_S = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)


def engine_authority() -> Study:
    """Return the figures of the two-input controllers between free authority and none."""
    cases = [
        ('free', EngineAuthority()),
        *((f'{limit:g} N m', EngineAuthority(deviation_n_m=limit)) for limit in DEVIATIONS_N_M),
        *((f'{rate:g} N m/s', EngineAuthority(slew_n_m_s=rate)) for rate in SLEWS_N_M_S),
        *((f'lag {1000.0 * lag:g} ms', EngineAuthority(lag_s=lag)) for lag in LAGS_S),
    ]
    rows: list[Sequence[str]] = [
        (controller, case, *_cells(controller, authority))
        for controller in CONTROLLERS
        for case, authority in cases
    ]
    rows += [(name, 'none', *_cells(name, EngineAuthority())) for name in ('mpc3', 'mpc_preview')]
    return Study(
        'Two inputs in the thesis scenario, by what the engine may do about the demand',
        ('controller', 'authority', *HEADERS, 'peak jerk m/s^3', 'friction kJ'),
        [tuple(row) for row in rows],
    )


def _cells(controller: str, authority: EngineAuthority) -> tuple[str, ...]:
    settings = RunSettings(replace(THESIS_SCENARIO, engine_authority=authority))
    trajectory = run_headless(settings, controller)
    metrics = metrics_of(settings, trajectory)
    energy = metrics.friction_energy_j
    return (
        *cells(settings, trajectory),
        text_or_dash(metrics.peak_jerk_m_s3, '.1f'),
        text_or_dash(None if energy is None else energy / 1000.0, '.2f'),
    )
