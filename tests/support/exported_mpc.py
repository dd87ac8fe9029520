# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Exported controllers, compiled, loaded and run in place of their Python originals."""

import ctypes
import shutil
import subprocess
from ctypes import POINTER, Structure, byref, c_double, c_int, c_ulong
from pathlib import Path
from typing import Any

import pytest

from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.mpc.export.export_controller import export_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

STRICT = (
    *('-std=c99', '-Wall', '-Wextra', '-Wpedantic', '-Werror', '-Wconversion', '-Wshadow'),
    *('-Wdouble-promotion', '-Wstrict-prototypes'),
)
STATUS = ('solved', 'iteration limit', 'infeasible', 'bad measurement')
NOT_IN_C = {'mpc_wear', 'mpc4_wear'}
"""Predictive controllers that the exported C does not cover: more than observer and program."""
_SIZES = """\
#include "ddct_mpc.h"
extern const int sizes[];
const int sizes[] = {DDCT_MPC_STATES, DDCT_MPC_MOVES, DDCT_MPC_REFERENCES,
                     DDCT_MPC_COMMANDS_ENGINE, (int)sizeof(ddct_mpc)};
"""


def compiler() -> str:
    """Return the C compiler, or skip the test."""
    path = shutil.which('cc')
    if path is None:
        pytest.skip('there is no C compiler cc')
    return path


def compile_c(folder: Path, *arguments: str) -> None:
    """Compile in `folder`; fail with the compiler's output, warnings included."""
    done = subprocess.run(
        [compiler(), *STRICT, *arguments], cwd=folder, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ''


class ExportedController(Controller):
    """Controller that runs the C code in a folder."""

    def __init__(self, folder: Path) -> None:
        """Compile and load the C code in `folder`."""
        (folder / 'sizes.c').write_text(_SIZES)
        compile_c(folder, '-O0', '-shared', '-fPIC', 'ddct_mpc.c', 'sizes.c', '-o', 'ddct_mpc.so')
        self._library = ctypes.CDLL(str(folder / 'ddct_mpc.so'))
        states, moves, references, commands_engine, size = (c_int * 5).in_dll(
            self._library, 'sizes'
        )
        self._state, self._measurement, command = _structures(states, moves, references)
        assert ctypes.sizeof(self._state) == size
        self._library.ddct_mpc_update.restype = command
        self._library.ddct_mpc_update.argtypes = [POINTER(self._state), POINTER(self._measurement)]
        self.preview_steps = references - 1
        self.commands_engine = bool(commands_engine)
        self.reset()

    @property
    def fallbacks(self) -> int:
        return self._controller.fallbacks

    def reset(self) -> None:
        self._controller = self._state()
        ctypes.memset(byref(self._controller), 0xFF, ctypes.sizeof(self._controller))
        self._library.ddct_mpc_reset(byref(self._controller))

    def hold(self, measurement: Measurement) -> None:
        status = self._library.ddct_mpc_hold(
            byref(self._controller), byref(self._filled(measurement))
        )
        self._require_good(status)

    def update(self, measurement: Measurement) -> Command:
        answer = self._library.ddct_mpc_update(
            byref(self._controller), byref(self._filled(measurement))
        )
        self._require_good(answer.status)
        status = (
            ('qp_status', STATUS[answer.status]),
            ('qp_iterations', str(answer.iterations)),
            ('fallbacks', str(self.fallbacks)),
        )
        engine_torque = answer.engine_torque if self.commands_engine else None
        return Command(answer.clutch_torque, status, engine_torque)

    def _filled(self, measurement: Measurement) -> Structure:
        filled = self._measurement()
        for name, kind in self._measurement._fields_:
            value = getattr(measurement, name)
            setattr(filled, name, value if kind is c_double else kind(*value))
        return filled

    def _require_good(self, status: int) -> None:
        if STATUS[status] == 'bad measurement':
            raise DdctError('bad measurement')


def run_settings(*changes: str, architecture: str = 'detailed', wear: float = 1.0) -> RunSettings:
    """Return two seconds of the thesis's scenario."""
    scenario = load_scenario('thesis', ['duration_s=2', *changes])
    return RunSettings(
        KnownSettings(scenario, architecture=architecture), CaseSettings(wear_gain=wear)
    )


def limited_settings(name: str, highest: float, rate: float, *changes: str) -> RunSettings:
    """Return settings with a highest torque and its rate, and three moves, of one controller."""
    section = f'controllers.{name}'
    return run_settings(
        f'{section}.highest_torque_n_m={highest}',
        f'{section}.torque_rate_n_m_s={rate}',
        f'{section}.control_steps=3',
        *changes,
    )


def exported(
    controller: Controller, name: str, settings: RunSettings, folder: Path
) -> ExportedController:
    """Return the exported C controller of `controller`, which was built for `settings`."""
    export_controller(controller, name, settings.known, folder)
    return ExportedController(folder)


def _structures(states: int, moves: int, references: int) -> tuple[Any, Any, Any]:
    """Return ddct_mpc, ddct_mpc_measurement and ddct_mpc_command."""
    scalars = ('engine_speed', 'shaft_speed', 'wheel_speed', 'engine_torque', 'load_torque')

    class State(Structure):
        _fields_ = (
            ('state', c_double * states),
            ('plan', c_double * moves),
            ('own_torque', c_double),
            ('open_loop_torque', c_double),
            ('engine_request', c_double),
            ('engine_asked', c_double),
            ('engine_deviation', c_double),
            ('fallbacks', c_ulong),
            ('started', c_int),
        )

    class Measured(Structure):
        _fields_ = (
            *((name, c_double) for name in (*scalars, 'open_loop_torque')),
            ('slip_reference', c_double * references),
            ('slip_reference_rate', c_double * references),
        )

    class Answer(Structure):
        _fields_ = (
            ('clutch_torque', c_double),
            ('engine_torque', c_double),
            ('status', c_int),
            ('iterations', c_int),
        )

    return State, Measured, Answer
