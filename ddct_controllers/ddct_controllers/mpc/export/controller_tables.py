# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Numbers of one predictive controller for the exported C: macros and constant arrays."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_controllers.interface import Controller
from ddct_controllers.measurement import MOST
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.export.dual_form import DualForm, dual_form, known_columns
from ddct_controllers.mpc.inputs import CLUTCH, ENGINE, ROOM
from ddct_controllers.mpc.model.transmission_model import MEASURED
from ddct_controllers.mpc.program.horizon import CondensedProgram
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import EngineAuthority

MEASURED_MACROS = {'MOST_MEASURED': MOST}
"""Largest size of a measured value, in its SI unit."""
CHANGES_PER_ROW = 10
"""Changes of the active set allowed for each row that can be active, if no limit is given."""


@dataclass(frozen=True, eq=False)
class ControllerTables:
    """Macros and constant arrays of the exported C, by their names there."""

    public: dict[str, int | float]
    """Macros of the header, by their names without the prefix DDCT_MPC_."""
    private: dict[str, int | float]
    arrays: dict[str, np.ndarray]
    """Constant vectors and matrices, by their names."""


def exportable(controller: Controller, name: str) -> tuple[MpcController[Observer], Observer]:
    """Return controller and observer; raise ParameterError for features that the C lacks."""
    if not isinstance(controller, MpcController):
        raise ParameterError(
            f'{name} cannot be exported: it is not a predictive controller; choose one, '
            'as mpc3 is',
            key=name,
        )
    observer = controller.observer
    # Classes made from these do something else, which would be missing in C without a word.
    if type(controller) is not MpcController or type(observer) is not Observer:
        raise ParameterError(
            f'{name} cannot be exported: the C has no {type(controller).__name__} with '
            f'{type(observer).__name__}; choose another, such as mpc3',
            key=name,
        )
    return controller, observer


def controller_tables(controller: MpcController[Observer], observer: Observer) -> ControllerTables:
    """Return the tables of a controller and observer from `exportable`."""
    settings, program, model = controller.settings, controller.program, observer.model
    form = dual_form(program.structure)
    columns = known_columns(program, len(model.a), settings)
    clutch = settings.inputs[CLUTCH]
    limits_rate = math.isfinite(clutch.rate_n_m_s)
    engine = _authority_macros(controller.authority) if controller.authority else {}
    return ControllerTables(
        public={
            'PERIOD_S': PERIOD_S,
            'COMMANDS_ENGINE': int(controller.commands_engine),
            'REFERENCES': controller.preview_steps + 1,
            'READS_REFERENCE_RATE': int(columns.rate_references > 0),
            'STATES': len(model.a),
            'MOVES': len(form.moves),
            'ITERATIONS': _iterations(settings, form),
        },
        private={
            'INPUTS': len(settings.inputs),
            'MEASURED': MEASURED,
            'STARTS_AT_REST': int(observer.start is not None),
            'FIRST_REFERENCE': int(settings.preview),
            'SLIP_REFERENCES': columns.slip_references,
            'RATE_REFERENCES': columns.rate_references,
            'ROWS': max(len(form.kept), 1),
            'ACTIVE': form.capacity,
            'LEAST_CLUTCH': clutch.lowest,
            'MOST_CLUTCH': clutch.highest,
            'LIMITS_RATE': int(limits_rate),
            'CLUTCH_CHANGE': clutch.rate_n_m_s * PERIOD_S,
            'ROOM': ROOM,
            **MEASURED_MACROS,
            **engine,
        },
        arrays={
            'A': model.a,
            'B': model.b,
            'GAIN': observer.gain,
            **_start(observer),
            'GRADIENT': form.to_dual @ columns.gradient,
            'MOVES': form.moves,
            **_rows(controller, form, columns.shift, limits_rate=limits_rate),
        },
    )


def _start(observer: Observer) -> dict[str, np.ndarray]:
    """Return the first estimate but for the speeds, and what C_load adds to it; {} for zero."""
    if observer.start is None:
        return {}
    unloaded, loaded = (
        observer.at_rest(observer.start, (0.0, 0.0, 0.0), load) for load in (0.0, 1.0)
    )
    return {'AT_REST': unloaded, 'AT_REST_PER_LOAD': loaded - unloaded}


def _rows(
    controller: MpcController[Observer], form: DualForm, shift: np.ndarray, *, limits_rate: bool
) -> dict[str, np.ndarray]:
    """Return the tables that have one entry or row for each constraint."""
    program, scale = controller.program, form.scale
    rows = {
        'NORMAL': form.normals,
        'RELAXATION': form.relaxation,
        'LOWER': program.lower[form.kept] * scale,
        'UPPER': program.upper[form.kept] * scale,
        'SHIFT': shift[form.kept] * scale[:, None],
    }
    # Bounds that each period sets: C has no use for these arrays without them.
    if limits_rate:
        rows['CLUTCH_PERIODS_AHEAD'] = _periods_ahead(program, CLUTCH)[form.kept]
    if controller.commands_engine:
        rows['ENGINE_PERIODS_AHEAD'] = _periods_ahead(program, ENGINE)[form.kept]
    if limits_rate or controller.commands_engine:
        rows['SCALE'] = scale
    if len(form.kept):
        return rows
    # C has no empty arrays: a row that restricts nothing.
    restricts_nothing = {'LOWER': -np.inf, 'UPPER': np.inf}
    return {
        name: np.full((1, *table.shape[1:]), restricts_nothing.get(name, 0.0))
        for name, table in rows.items()
    }


def _periods_ahead(program: CondensedProgram, of_input: int) -> np.ndarray:
    """Return the number of periods ahead at which a row limits the input; 0 for other rows."""
    periods, rows = np.zeros(len(program.lower)), program.level_rows[of_input]
    periods[rows] = np.arange(1, len(rows) + 1)
    return periods


def _iterations(settings: MpcSettings, form: DualForm) -> int:
    """Return the largest number of changes of the solver's active set in one call."""
    if settings.iteration_limit is not None and settings.backend == 'daqp':
        return settings.iteration_limit  # counted in the same unit
    return CHANGES_PER_ROW * form.capacity


def _authority_macros(authority: EngineAuthority) -> dict[str, float]:
    """Return what a controller may do to the engine; a change is that in one period, in N m."""
    return {
        'MOST_DEVIATION': authority.deviation_n_m,
        'MOST_CHANGE': authority.slew_n_m_s * PERIOD_S,
        'LAG_SHARE': authority.lag_share,
        'LEAST_ENGINE_TORQUE': authority.minimum_torque_n_m,
        'MOST_ENGINE_TORQUE': authority.maximum_torque_n_m,
    }
