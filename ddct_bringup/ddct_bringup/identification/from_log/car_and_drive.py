# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Files of the car and the drive of a log."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.identification.from_log.car_of_log import base_of_car, car_of
from ddct_bringup.identification.from_log.drive_of_log import LogDrive
from ddct_bringup.identification.from_log.origins import commented, origins
from ddct_plant.base.errors import LONGEST_NAME, DdctError
from ddct_plant.files.csv_table import csv_text
from ddct_plant.files.output_file import require_new, write_text
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.scenario.choices.scenarios import Choice
from ddct_plant.scenario.nouns.composed import files_of_noun
from ddct_plant.scenario.nouns.keys import CAR, DRIVE, NOUNS

PROFILES = {'engine': ('torque_n_m', 'N m'), 'slope': ('slope_rad', 'rad')}
"""Sections of a drive that have a CSV file, with the quantity and its unit."""
_COLUMNS = {'time': 'time_s'}
_AROUND = f'_{DRIVE}__{CAR}'
"""What the name of a run has beside that of the log, twice."""


@dataclass(frozen=True)
class OutFolder:
    """The folder of `--out`, and its files by what is in them."""

    folder: Path
    log: Path

    @property
    def files(self) -> dict[str, Path]:
        """Files of car, drive, and the profiles."""
        ends = {CAR: '.yaml', DRIVE: '.yaml', **dict.fromkeys(PROFILES, '.csv')}
        return {what: self.folder / f'{self.name}_{what}{end}' for what, end in ends.items()}

    @property
    def name(self) -> str:
        """Name of the log's file, with allowed characters only, short enough for that of a run."""
        plain = re.sub(r'[^A-Za-z0-9._-]', '_', self.log.stem).lstrip('.-')
        return plain[: (LONGEST_NAME - len(_AROUND)) // 2] or 'log'

    def require_new(self, *, overwrite: bool) -> None:
        """Raise DdctError where a file exists; with `overwrite` where it is no car or drive."""
        if self.folder.exists() and not self.folder.is_dir():
            raise DdctError(f'--out {self.folder} is a file: name a folder', key='--out')
        for what, path in self.files.items():
            require_new('--out', path, overwrite=overwrite)
            if what not in NOUNS or not path.exists():
                continue
            try:
                files_of_noun(what, str(path.resolve()))
            except DdctError as error:
                raise DdctError(
                    f'{path} is no {what}, and --overwrite replaces only that: choose another '
                    f'--out ({error})',
                    key='--out',
                ) from error


def write_car_and_drive(
    out: OutFolder, choice: Choice, overrides: Sequence[str], drive: LogDrive
) -> list[str]:
    """
    Write the car, the drive and its profiles; the fit started from `choice` and `overrides`.

    Return where the values of the car are from, as sentences, which its file has too. Raise
    DdctError, before any file is written, for a C_load that no slope gives.
    """
    texts, content = {}, drive.content()
    for section, rows in drive.tables().items():
        value, unit = PROFILES[section]
        content[section] = {'csv': out.files[section].name, **_COLUMNS}
        content[section] |= {'value': value, 'unit': unit}
        texts[section] = csv_text((_COLUMNS['time'], value), rows)
    texts[DRIVE] = dump_yaml(content)
    car = car_of(out.folder, choice, overrides, drive)
    found = origins(car, base_of_car(choice), drive.fit)
    texts[CAR] = commented(found) + dump_yaml(car)
    out.folder.mkdir(parents=True, exist_ok=True)
    for what, text in texts.items():
        write_text(str(out.files[what]), text)
    return found
