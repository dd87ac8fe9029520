# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Hand-written C of the exports: files in folders, and those that several exports share."""

from collections.abc import Iterable
from pathlib import Path

from ddct_controllers.measurement import MOST
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import EngineAuthority

_SHARED = Path(__file__).parent / 'c'
DOUBLES = _SHARED / 'doubles.c'
"""Functions `smaller`, `larger` and `usable`, which every export needs, with `MEASURED_MACROS`."""
MEASURED_MACROS = {'MOST_MEASURED': MOST}
"""Largest size of a measured value, in its SI unit."""
ENGINE = _SHARED / 'engine.c'
"""Torque that the engine delivers; it needs DOUBLES and the macros of `authority_macros`."""


def text_of(files: Iterable[Path]) -> str:
    """Return the text of files, one after another."""
    return '\n'.join(file.read_text(encoding='utf-8') for file in files)


def authority_macros(authority: EngineAuthority) -> dict[str, float]:
    """Return what a controller may do to the engine; a change is that in one period, in N m."""
    return {
        'MOST_DEVIATION': authority.deviation_n_m,
        'MOST_CHANGE': authority.slew_n_m_s * PERIOD_S,
        'LAG_SHARE': authority.lag_share,
        'LEAST_ENGINE_TORQUE': authority.minimum_torque_n_m,
        'MOST_ENGINE_TORQUE': authority.maximum_torque_n_m,
    }
