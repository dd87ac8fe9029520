# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The column map of a log to be fitted: the user's, that of our own files, or a guessed one."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from ddct_bringup.logs.columns import TIME, ColumnMap, load_columns, own_columns
from ddct_bringup.logs.guess import guessed_columns
from ddct_bringup.logs.sources import MDF, source_of
from ddct_bringup.logs.wheel_radius import VEHICLE_SPEED
from ddct_plant.base.errors import DdctError, printable
from ddct_plant.files.output_file import STDOUT, require_new, write_text
from ddct_plant.scenario.scenario import Scenario

_FULL_N_M = 250.0
"""Torque that is taken for 100 % where the car has no engine limits, N m."""


def columns_of(options: argparse.Namespace, car: Scenario, needed: Sequence[str]) -> ColumnMap:
    """
    Return the column map of the log of `identify`.

    One that is guessed is printed, and written where `--guess` says. Raise DdctError where it
    lacks one of the `needed` quantities.
    """
    if options.columns and (options.dbc or options.guess):
        raise DdctError('--columns with --dbc or --guess: leave these out, the map has dbc')
    if options.columns:
        return load_columns(options.columns)
    own = own_columns(TIME, *needed, optional=(VEHICLE_SPEED,))
    if options.log.suffix == '.mcap' or not options.log.is_file():  # read_log refuses what is none
        if options.guess:
            bag = options.log.exists()
            why = (
                'a bag needs no column map: leave out --guess' if bag else 'no such file or folder'
            )
            raise DdctError(why, place=options.log)
        return own
    source = source_of(options.log, options.dbc)
    names = {name for key in (TIME, *needed) for name in own.columns[key].names}
    if source.units().keys() & names and not options.guess:
        return own
    limits = car.engine_limits
    full = limits.most_torque if limits else _FULL_N_M
    guess = guessed_columns(source, car.vehicle.wheel_radius_m, full, options.dbc)
    folder = Path() if options.guess in (None, STDOUT) else Path(options.guess).parent
    text = guess.text(options.log.name, folder, (TIME, *needed))
    if options.guess:
        require_new('--guess', options.guess, overwrite=options.overwrite)
        write_text(options.guess, f'{text}\n')
    out = sys.stderr if STDOUT in (options.json, options.guess) else sys.stdout
    print('\n'.join(map(printable, text.splitlines())), file=out)
    missing = [name for name in (TIME, *needed) if name not in guess.columns.columns]
    is_mdf = options.log.suffix.lower() in MDF
    of_bus = '; frames of a bus need --dbc' if is_mdf and not options.dbc else ''
    if missing and not options.guess:
        raise DdctError(
            f'no column is taken for {", ".join(missing)}: write the map above into a file by '
            f'--guess FILE, complete it, and give it as --columns{of_bus}',
            place=options.log,
        )
    return guess.columns
