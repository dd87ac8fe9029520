# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `limit`: compute the least that any controller could do, for each lock time."""

import argparse
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.front import (
    ControllerRow,
    LeastLockTime,
    controller_rows,
    front,
    least_lock_time,
    usual_lock_times,
)
from ddct_bringup.floor.values import METRICS, OF_STICK_SLIP, Floor
from ddct_bringup.run.options import (
    ALL,
    add_settings_options,
    controllers_of,
    print_choices,
)
from ddct_bringup.run.plan import require_headless
from ddct_bringup.run.run_base import settings_of
from ddct_controllers.registry import controller_label, working_controllers
from ddct_plant.base.errors import DdctError, ParameterError, require_number
from ddct_plant.base.options import require_known
from ddct_plant.files.input_file import located
from ddct_plant.files.output_file import STDOUT, require_place, write_json
from ddct_plant.program.command_line import ProgramParser, complain, run_program
from ddct_plant.program.progress import with_progress
from ddct_plant.program.table import Table, print_table, text_or_dash
from ddct_plant.scenario.settings import RunSettings

PROGRAM = 'ddct limit'
_PICTURES = ('.png', '.svg')
_HOW_TIMES = 'write START:STOP:COUNT, such as 0.4:1.4:11, or A,B,C, in s after control start'
_MOST_TIMES = 1000
_EPILOG = """examples:
  ddct limit --scenario launch --clutch stick_slip --metrics peak_jerk --controllers ls8,hinf1
  ddct limit --scenario launch --clutch stick_slip --lock-times 0.6:1.4:9 --figure front.png
  ddct limit --cap peak_jerk=6 --metrics peak_jerk --scenario launch --clutch stick_slip --json -

For each lock time: the least value of a metric that any torque request can lead to, with the
proof checked, and the value that a run of the simulated plant attains. docs/use/limit.md says
what a floor is. A lock time that no request leads to is on standard error, with its proof.
Floors are kept in the folder DDCT_CACHE, by default ~/.cache/ddct; DDCT_CACHE= keeps none.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _limit, argv)


def _limit(argv: list[str]) -> int:
    options = _parser().parse_args(argv)
    if options.list:
        print_choices()
        return 0
    metrics = _metrics(options.metrics or ','.join(METRICS))
    caps = [_cap(text, metrics) for text in options.cap]
    require_place('--json', options.json)
    if options.figure:
        if Path(options.figure).suffix not in _PICTURES:
            raise ParameterError(
                f'--figure {options.figure}: name a file that ends in .png or .svg'
            )
        require_place('--figure', options.figure)
    names = controllers_of(options.controllers) if options.controllers else []
    settings = settings_of(options, [controller_label(name) for name in names])
    require_headless(settings)
    if options.controllers == ALL:
        names = working_controllers(settings, partial(complain, PROGRAM))
    if not options.metrics and not settings.stick_slip:
        metrics.remove(OF_STICK_SLIP)
    times = _times(options.lock_times) if options.lock_times else usual_lock_times(settings)
    start = control_start(settings)
    points = with_progress(front(settings, metrics, times, start), len(times), 'lock times')
    floors = [floor for point in points for floor in point]
    impossible = _complain_impossible(floors)
    rows: list[ControllerRow] = []
    for name in with_progress(names, len(names), 'controllers'):
        rows += controller_rows(settings, name, metrics, start)
    capped = [least_lock_time(floors, metric, cap) for metric, cap in caps]
    if options.json:
        write_json(options.json, _document(floors, rows, capped))
    if options.json != STDOUT:
        _print(floors, rows, capped)
    if options.figure:
        # Only here: matplotlib takes long to import.
        from ddct_bringup.floor.figure import write_front_figure

        write_front_figure(floors, rows, _title(settings), Path(options.figure))
    return 1 if impossible == len(times) else 0


def _complain_impossible(floors: Sequence[Floor]) -> int:
    """Print a line for each lock time that no request leads to; return their number."""
    impossible: dict[float, Floor] = {}
    for floor in floors:
        if floor.least is None:
            impossible.setdefault(floor.lock_time_s, floor)
    for time_s, floor in impossible.items():
        complain(
            PROGRAM,
            f'lock time {time_s:g} s: no torque request locks the plates then: a Farkas ray of '
            f'sum {floor.certificate["proven"]:.3g}, which must be above 0, proves it: give '
            'another time',
        )
    return len(impossible)


def _document(
    floors: Sequence[Floor], rows: Sequence[ControllerRow], capped: Sequence[LeastLockTime]
) -> dict[str, Any]:
    """Return the document of `--json`."""
    return {
        'front': [floor.as_dict() for floor in floors],
        'controllers': list(rows),
        'least_lock_times': list(capped),
    }


def _print(
    floors: Sequence[Floor], rows: Sequence[ControllerRow], capped: Sequence[LeastLockTime]
) -> None:
    print_table(
        Table(
            'least value of each metric by lock time, and what a run attains',
            ('lock s', 'metric', 'unit', 'least', 'attained', 'gap %', 'proof'),
            [
                (
                    f'{floor.lock_time_s:.2f}',
                    floor.metric,
                    METRICS[floor.metric],
                    text_or_dash(floor.least, '.4g'),
                    text_or_dash(floor.attained, '.4g'),
                    text_or_dash(floor.gap, '.1f'),
                    floor.certificate['kind'],
                )
                for floor in floors
            ],
        )
    )
    if rows:
        print_table(
            Table(
                'controllers, over the least at their own lock time',
                ('controller', 'lock s', 'metric', 'value', 'least', 'over least'),
                [
                    (
                        row['controller'],
                        text_or_dash(row['lock_time_s'], '.3f'),
                        row['metric'],
                        text_or_dash(row['value'], '.4g'),
                        text_or_dash(row['least'], '.4g'),
                        text_or_dash(row['over_floor'], '.2f'),
                    )
                    for row in rows
                ],
            )
        )
    for each in capped:
        found = each['lock_time_s']
        text = 'no lock time of the grid' if found is None else f'a lock at {found:g} s'
        before = each['excluded_before_s']
        proof = 'proven for none' if before is None else f'impossible before {before:g} s'
        print(f'{each["metric"]} of {each["cap"]:g} at most: {text}; {proof}')


def _title(settings: RunSettings) -> str:
    return f'{settings.scenario.name}, clutch {settings.clutch}, wear gain {settings.wear_gain:g}'


def _metrics(text: str) -> list[str]:
    names = [name.strip() for name in text.split(',') if name.strip()]
    with located('--metrics'):
        require_known(names, METRICS, 'metric')
    if not names:
        raise ParameterError('--metrics is empty: name at least one')
    return list(dict.fromkeys(names))


def _cap(text: str, metrics: Sequence[str]) -> tuple[str, float]:
    metric, _, value = text.partition('=')
    if metric not in metrics:
        raise ParameterError(f'--cap {text}: write METRIC=VALUE with a metric of --metrics')
    return metric, _number('--cap', value, 'write METRIC=VALUE')


def _times(text: str) -> list[float]:
    """Return the lock times of START:STOP:COUNT or A,B,C in s."""
    parts = text.split(':')
    if len(parts) == 1:
        times = [_number('--lock-times', part, _HOW_TIMES) for part in text.split(',')]
    elif len(parts) == 3 and parts[2].isdigit() and 2 <= int(parts[2]) <= _MOST_TIMES:
        first, last = (_number('--lock-times', part, _HOW_TIMES) for part in parts[:2])
        count = int(parts[2])
        times = [round(first + (last - first) * i / (count - 1), 6) for i in range(count)]
    else:
        raise ParameterError(f'--lock-times {text}: {_HOW_TIMES}')
    if sorted(set(times)) != times:
        raise ParameterError(f'--lock-times {text}: give rising times')
    return times


def _number(option: str, text: str, how: str) -> float:
    try:
        return require_number(option, float(text), at_least=0.0)
    except (ValueError, DdctError) as error:
        raise ParameterError(f'{option} {text}: {how}') from error


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Compute the least that any controller of the clutch could do.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        '--controllers',
        default='',
        metavar='A,B,...|all',
        help='also compare these with the least at their own lock time; default: none',
    )
    parser.add_argument(
        '--metrics',
        default='',
        metavar='A,B,...',
        help=f'metrics, named as in verdicts and scores; default: all, {", ".join(METRICS)}',
    )
    parser.add_argument(
        '--lock-times',
        metavar='START:STOP:COUNT',
        help='times of the lock in s after control start, also A,B,C; default: 15 up to the end '
        'of the score window',
    )
    parser.add_argument(
        '--cap',
        action='append',
        default=[],
        metavar='METRIC=VALUE',
        help='also find the least lock time at which a metric is at most this; may be repeated',
    )
    parser.add_argument('--json', metavar='FILE', help="also write it as JSON; '-' is stdout")
    parser.add_argument('--figure', metavar='FILE', help='also draw it: a .png or .svg file')
    add_settings_options(parser)
    return parser


if __name__ == '__main__':
    raise SystemExit(main())
