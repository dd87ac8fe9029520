# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Maps of docs/thesis/robustness_map.md: final states of the runs of two campaigns, as text."""

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from pyarrow import parquet

from ddct_bringup.campaign.spec import CampaignSpec, read_spec
from ddct_bringup.verdict.state import STATES
from generator.pages import DOCS

SPECS = {name: DOCS / 'examples' / f'robustness_{name}.yaml' for name in ('delay', 'mass')}
RECORD = DOCS / 'thesis' / 'robustness_map.json'
LETTERS = dict(zip(STATES, 'EenoRsvtfX', strict=True))
"""Letters by state."""
ARCHITECTURE, CLUTCH, WEAR = 'architecture', 'clutch', 'wear_gain'
THIRD = {'delay': 'actuator.delay_s', 'mass': 'vehicle.mass_kg'}
"""Key that varies besides architecture, clutch and wear, by map."""
JERK = 'peak_jerk_m_s3'


@dataclass(frozen=True)
class StateMap:
    """Final states of the runs of one campaign."""

    spec: CampaignSpec
    states: np.ndarray
    """States by controller, architecture, clutch, the third key, and wear gain."""
    jerk: np.ndarray
    """Peak jerk in m/s^3, with the axes of `states`; NaN where it is not defined."""
    third: str
    """Name of the third key."""

    def line(self, controller: str, *point: Any) -> list[str]:
        """Return the states over the wear gains at architecture, clutch and third value."""
        return self.states[self._place(controller, point)].tolist()

    def plane(self, controller: str, architecture: str, clutch: str) -> list[list[str]]:
        """Return the states over the wear gains, a row for each third value."""
        return self.states[self._place(controller, (architecture, clutch))].tolist()

    def jerk_at(self, controller: str, *point: Any) -> float:
        """Return the peak jerk at architecture, clutch, third value and wear gain."""
        return float(self.jerk[self._place(controller, point)])

    def values(self, key: str) -> tuple[Any, ...]:
        """Return the values of a key."""
        return self.spec.grid[key]

    @property
    def digest(self) -> str:
        """Hash of the states."""
        return hashlib.sha256(' '.join(self.states.ravel().tolist()).encode()).hexdigest()

    def _place(self, controller: str, point: Sequence[Any]) -> tuple[int, ...]:
        given = zip(self.spec.grid.values(), point, strict=False)
        return (
            self.spec.controllers.index(controller),
            *(values.index(value) for values, value in given),
        )


def spec_digest(spec: CampaignSpec) -> str:
    """Return a hash of the content of a specification without its comments."""
    return hashlib.sha256(spec.text().encode()).hexdigest()


def kept_maps() -> dict[str, StateMap]:
    """Return the maps of the record; raise ValueError where a specification has changed since."""
    record = json.loads(RECORD.read_text(encoding='utf-8'))
    return {name: _map(name, record['maps'][name], record['letters']) for name in SPECS}


def _map(name: str, kept: Mapping[str, Any], letters: Mapping[str, str]) -> StateMap:
    spec = read_spec(SPECS[name])
    if kept['spec'] != spec_digest(spec):
        raise ValueError(f'{SPECS[name]} has changed: compute its map again')
    shape = (len(spec.controllers), *(len(values) for values in spec.grid.values()))
    words = {letter: state for state, letter in letters.items()}
    states = [words[letter] for *_, line in kept['states'] for letter in line]
    jerk = [math.nan if value is None else value for line in kept[JERK] for value in line]
    return StateMap(
        spec, np.array(states).reshape(shape), np.array(jerk).reshape(shape), THIRD[name]
    )


def record_of(campaigns: Mapping[str, Path]) -> dict[str, Any]:
    """Return the record of the campaigns' folders: a line of letters over the wear gains."""
    return {'letters': LETTERS, 'maps': {name: _kept(name, campaigns[name]) for name in SPECS}}


def _kept(name: str, campaign: Path) -> dict[str, Any]:
    spec = read_spec(SPECS[name])
    keys = ('controller', *spec.grid)
    columns = [*keys, 'verdict_state', JERK]
    rows = parquet.read_table(campaign / 'results.parquet', columns=columns).to_pylist()
    expected = list(product(spec.controllers, *spec.grid.values()))
    if [tuple(row[key] for key in keys) for row in rows] != expected:
        raise ValueError(f'{campaign}: these are not the runs of {SPECS[name]}')
    length = len(spec.grid[WEAR])
    lines = [rows[first : first + length] for first in range(0, len(rows), length)]
    return {
        'spec': spec_digest(spec),
        'states': [
            [
                *(line[0][key] for key in keys if key != WEAR),
                ''.join(LETTERS[row['verdict_state']] for row in line),
            ]
            for line in lines
        ],
        JERK: [
            [None if row[JERK] is None else float(f'{row[JERK]:.3g}') for row in line]
            for line in lines
        ],
    }


def keep(folders: Sequence[str]) -> None:
    """Write the record of the campaigns in the folders for delay and for mass."""
    record = record_of(dict(zip(SPECS, map(Path, folders), strict=True)))
    text = json.dumps(record).replace('], [', '],\n[').replace(': [[', ':\n[[')
    RECORD.write_text(f'{text}\n', encoding='utf-8')
