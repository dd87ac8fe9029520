# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `limit`: compute the least that any controller could do, for each lock time."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.front import (
    ControllerRow,
    LeastLockTime,
    LimitDocument,
    controller_rows,
    floor_row,
    front,
    least_lock_time,
    usual_lock_times,
)
from ddct_bringup.floor.lock import counted_from
from ddct_bringup.floor.values import METRICS, OF_STICK_SLIP, Floor
from ddct_bringup.programs.limit_options import cap_of, limit_parser, lock_times_of
from ddct_bringup.run.options import (
    ALL,
    controllers_of,
    metrics_of,
    print_choices,
)
from ddct_bringup.run.plan import require_headless
from ddct_bringup.run.run_base import settings_of
from ddct_bringup.scores.shift_conditions import shift_conditions
from ddct_controllers.registry import controller_label, working_controllers
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import STDOUT, require_picture, require_place
from ddct_plant.program.command_line import complain, run_program
from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.progress import with_progress
from ddct_plant.program.table import UNDEFINED, Table, Weight, text_or_dash, with_reasons
from ddct_plant.scenario.settings import RunSettings

PROGRAM = 'ddct limit'
_COMPLETE = '--json FILE'


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _limit, argv)


def _limit(argv: list[str]) -> int:
    options = limit_parser(PROGRAM).parse_args(argv)
    if options.list:
        print_choices()
        return 0
    metrics = metrics_of('--metrics', options.metrics or ','.join(METRICS), METRICS)
    caps = [cap_of(text, metrics) for text in options.cap]
    require_place('--json', options.json)
    require_picture('--figure', options.figure)
    names = controllers_of(options.controllers) if options.controllers else []
    settings = settings_of(options, [controller_label(name) for name in names])
    require_headless(settings)
    if options.controllers == ALL:
        names = working_controllers(settings, partial(complain, PROGRAM))
    if not options.metrics and not settings.stick_slip:
        metrics.remove(OF_STICK_SLIP)
    start = control_start(settings)
    given = options.lock_times
    times = lock_times_of(given) if given else usual_lock_times(settings, start)
    points = with_progress(front(settings, metrics, times, start), len(times), 'lock times')
    floors = [floor for point in points for floor in point]
    impossible = _complain_impossible(floors)
    rows: list[ControllerRow] = []
    for name in with_progress(names, len(names), 'controllers'):
        rows += controller_rows(settings, name, metrics, start)
    capped = [least_lock_time(floors, metric, cap) for metric, cap in caps]
    if options.json:
        document = LimitDocument([floor_row(each) for each in floors], rows, capped)
        write_json(options.json, document)
    if options.json != STDOUT:
        _print(floors, rows, capped)
    if options.figure:
        # Only here: matplotlib takes long to import.
        from ddct_bringup.floor.figure import write_front_figure

        write_front_figure(
            floors, rows, _title(settings), Path(options.figure), counted_from(settings)
        )
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
            f'sum {floor.certificate.proven:.3g}, which must be above 0, proves it: give '
            'another time',
        )
    return len(impossible)


def _print(
    floors: Sequence[Floor], rows: Sequence[ControllerRow], capped: Sequence[LeastLockTime]
) -> None:
    least = Table(
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
                floor.certificate.kind,
            )
            for floor in floors
        ],
        weights=(
            *(Weight.IDENTIFYING, Weight.IDENTIFYING, *[Weight.NEEDED] * 4),
            Weight.DETAIL,
        ),
        complete=_COMPLETE,
    )
    print_table(with_reasons(least, _no_floor))
    if rows:
        ratios = Table(
            'controllers, over the least at their own lock time',
            ('controller', 'lock s', 'metric', 'value', 'least', 'over least'),
            [
                (
                    row.controller,
                    text_or_dash(row.lock_time_s, '.3f'),
                    row.metric,
                    text_or_dash(row.value, '.4g'),
                    text_or_dash(row.least, '.4g'),
                    text_or_dash(row.over_floor, '.2f'),
                )
                for row in rows
            ],
            weights=(Weight.IDENTIFYING, Weight.NEEDED, Weight.IDENTIFYING),
            complete=_COMPLETE,
        )
        print_table(with_reasons(ratios, _no_ratio))
    for each in capped:
        found = each.lock_time_s
        text = 'no lock time of the grid' if found is None else f'a lock at {found:g} s'
        before = each.excluded_before_s
        proof = 'proven for none' if before is None else f'impossible before {before:g} s'
        print_note(f'{each.metric} of {each.cap:g} at most: {text}; {proof}')


def _no_floor(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash in the table of the front."""
    *_, least, attained, _, _ = row
    if least == UNDEFINED:
        return 'no torque request locks the plates at that time'
    if attained == UNDEFINED:
        return 'no run with that lock was found'
    return 'the least is 0'


def _no_ratio(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash in the table of controllers."""
    _, lock, _, value, least, _ = row
    if lock == UNDEFINED:
        return 'the clutch does not lock for good'
    if value == UNDEFINED:
        return 'the run has no value of this metric'
    return 'no least is known at that lock time' if least == UNDEFINED else 'the least is 0'


def _title(settings: RunSettings) -> str:
    parts = [
        settings.scenario.name,
        f'clutch {settings.clutch}',
        f'wear gain {settings.wear_gain:g}',
    ]
    return ', '.join([*parts, *shift_conditions(settings).values()])


if __name__ == '__main__':
    raise SystemExit(main())
