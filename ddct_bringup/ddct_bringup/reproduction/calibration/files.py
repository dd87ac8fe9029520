"""The files that a calibration writes: scenarios, and the tables of docs/calibration.md."""

from collections.abc import Sequence

from ddct_bringup.reproduction.calibration.problem import Problem
from ddct_bringup.reproduction.calibration.record import Record
from ddct_bringup.reproduction.calibration.tables import all_tables
from ddct_plant.program.page_tables import fill_tables
from ddct_plant.scenario.scenario import Scenario

_SCENARIO_HEAD = (
    '# The slip phase behind Table 5.1 of the thesis, which does not print it.',
    '# Written by `ros2 run ddct_bringup reproduce calibration --write FILE`;'
    ' docs/calibration.md tells how.',
    '# fitted: to the LS8, Hinf1 and PI rows of Table 5.1; what they show is a fit residual.',
    '# assumed: chosen by us; docs/calibration.md shows fits with other choices.',
)


def scenario_text(record: Record) -> str:
    """Return the calibrated scenario as YAML, with comments on where each value comes from."""
    values = [entry['frozen'] for entry in record['parameters']]
    return annotated_yaml(Problem(record['score_window_s'][1]).scenario(values), _SCENARIO_HEAD)


def annotated_yaml(scenario: Scenario, head: Sequence[str]) -> str:
    """Return a scenario of the calibrated kind as YAML below its head of comments."""
    first, last = scenario.score_window_s
    time, torque = (list(part) for part in (scenario.engine.time_s, scenario.engine.torque_n_m))
    lines = [
        (f'description: {scenario.description}', ''),
        (f'duration_s: {scenario.duration_s}', 'assumed'),
        (f'control_start_s: {scenario.control_start_s}', 'thesis, Section 1.4.1'),
        (f'score_window_s: [{first}, {last}]', 'from control start; the end is fitted'),
        ('engine:', ''),
        (f'  time_s: {time}', 'the end of the rise is fitted'),
        (f'  torque_n_m: {torque}', 'fitted; only the rise is determined, not its level'),
        ('initial:', 'assumed: no slip; 160 rad/s is 20 km/h in second gear'),
        *((f'  {name}: {value}', '') for name, value in vars(scenario.initial).items()),
        ('load:', 'assumed: a level road; an ordinary car has 0.32 and 0.0125'),
        *((f'  {name}: {value}', '') for name, value in vars(scenario.load).items()),
        ('reference:', ''),
        (f'  slope_rad_s2: {scenario.reference.slope_rad_s2}', 'fitted'),
        ('controllers:', ''),
        ('  pi:', 'fitted, to the PI row only'),
        *((f'    {name}: {gain}', '') for name, gain in scenario.controllers['pi'].items()),
    ]
    body = [f'{text:<37} # {comment}' if comment else text for text, comment in lines]
    return '\n'.join([*head, *body, ''])


def fill_page(page: str, record: Record) -> str:
    """
    Return the page with its tables from the record; what stands around them is kept.

    Raise DdctError unless the page has each table of `all_tables` once.
    """
    return fill_tables(page, 'calibration', all_tables(record))
