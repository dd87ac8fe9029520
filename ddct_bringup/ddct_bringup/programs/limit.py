# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `limit`: the least that any controller could do, for each lock time."""

import argparse
from functools import partial
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.floor.metric_units import METRICS, OF_STICK_SLIP
from ddct_bringup.programs.options.of_limit import cap_of, limit_parser, lock_times_of
from ddct_bringup.programs.options.of_runs import ALL, settings_given
from ddct_plant.files.output_file import STDOUT, require_picture, require_place
from ddct_plant.program.command_line import complain, run_program

PROGRAM = 'ddct limit'
_complain = partial(complain, PROGRAM)


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _limit, argv)


def _limit(argv: list[str]) -> int:
    options = limit_parser(PROGRAM).parse_args(argv)
    if options.list:
        shell.print_choices()
        return 0
    metrics = shell.metrics_of('--metrics', options.metrics or ','.join(METRICS), METRICS)
    caps = [cap_of(text, metrics) for text in options.cap]
    require_place('--json', options.json)
    require_picture('--figure', options.figure)
    settings, controllers = _chosen(options)
    if not options.metrics and not settings.stick_slip:
        metrics.remove(OF_STICK_SLIP)
    times = lock_times_of(options.lock_times) if options.lock_times else None
    found = shell.least_values(
        settings, metrics, times, controllers, caps, workers=options.workers
    )
    for time_s, floor in found.impossible.items():
        _complain(
            f'lock time {time_s:g} s: no torque request locks the plates then, with the engine '
            f'below its cut: a Farkas ray of sum {floor.certificate.proven:.3g}, which must be '
            'above 0, proves it: give another time'
        )
    if options.json:
        shell.write_json(options.json, found.written)
    if options.json != STDOUT:
        shell.print_document(found.shown)
    if options.figure:
        found.draw(Path(options.figure))
    return 0 if found.any_possible else 1


def _chosen(options: argparse.Namespace) -> tuple['shell.RunSettings', list[str]]:
    """Return the settings and the controllers that options give; print adjusted values."""
    everyone = options.controllers == ALL
    names = shell.controller_names() if everyone else []
    if options.controllers and not everyone:
        names = shell.controllers_of(options.controllers)
    labels = [shell.controller_label(name) for name in names]
    settings = shell.run_settings(labels, **settings_given(options))
    shell.print_adjusted(settings.scenario)
    shell.require_headless(settings)
    return settings, shell.working_controllers(settings.known, _complain) if everyone else names


if __name__ == '__main__':
    raise SystemExit(main())
