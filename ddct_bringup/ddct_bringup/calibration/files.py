"""The two files that a calibration writes: the scenario, and the tables of docs/calibration.md."""

from ddct_bringup.calibration.parameters import BASE
from ddct_bringup.calibration.record import NAMES, Record
from ddct_bringup.calibration.tables import all_tables
from ddct_plant.page_tables import fill_tables

_SCENARIO_HEAD = (
    '# The slip phase behind Table 5.1 of the thesis, which does not print it.',
    '# Written by `ros2 run ddct_bringup calibrate --write FILE`; docs/calibration.md tells how.',
    '# fitted: to the LS8, Hinf1 and PI rows of Table 5.1; what they show is a fit residual.',
    '# assumed: chosen by us; docs/calibration.md shows fits with other choices.',
)


def scenario_text(record: Record) -> str:
    """Return the scenario as YAML, with comments on where each value comes from."""
    frozen = {entry['name']: entry['frozen'] for entry in record['parameters']}
    first, last = record['score_window_s']
    lines = [
        (f'description: {BASE.description}', ''),
        (f'duration_s: {BASE.duration_s}', 'assumed'),
        (f'control_start_s: {BASE.control_start_s}', 'thesis, Section 1.4.1'),
        (f'score_window_s: [{first}, {last}]', 'from control start; the end is fitted'),
        ('engine:', ''),
        (f'  time_s: [0.0, {frozen["rise_end_s"]}]', 'the end of the rise is fitted'),
        (
            f'  torque_n_m: [{frozen["torque_start_n_m"]}, {frozen["torque_end_n_m"]}]',
            'fitted; only the rise is determined, not its level',
        ),
        ('initial:', 'assumed: 20 km/h in second gear, no slip'),
        *((f'  {name}: {value}', '') for name, value in vars(BASE.initial).items()),
        ('load:', 'assumed: an ordinary car on a level road'),
        *((f'  {name}: {value}', '') for name, value in vars(BASE.load).items()),
        ('reference:', ''),
        (f'  slope_rad_s2: {frozen["slope_rad_s2"]}', 'fitted'),
        ('controllers:', ''),
        ('  pi:', 'fitted, to the PI row only'),
        *((f'    {name}: {frozen[name]}', '') for name in NAMES[4:]),
    ]
    body = [f'{text:<37} # {comment}' if comment else text for text, comment in lines]
    return '\n'.join([*_SCENARIO_HEAD, *body, ''])


def fill_page(page: str, record: Record) -> str:
    """
    Return the page with its tables from the record; what stands around them is kept.

    Raise DdctError unless the page has each table of `all_tables` once.
    """
    return fill_tables(page, 'calibrate', all_tables(record))
