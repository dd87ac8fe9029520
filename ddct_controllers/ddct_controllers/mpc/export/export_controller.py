# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write a predictive controller and its observer as self-contained C99."""

import math
from pathlib import Path

from ddct_controllers.from_file.c_library.library import HEADER as INTERFACE
from ddct_controllers.from_file.c_library.library import TEMPLATE
from ddct_controllers.interface import Controller
from ddct_controllers.mpc.export.controller_tables import (
    ControllerTables,
    controller_tables,
    exportable,
)
from ddct_controllers.mpc.export.folder import require_free, write_files
from ddct_controllers.mpc.export.text import constants, macros, remark
from ddct_controllers.mpc.model.transmission_model import SLIP_SPEED
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_plant.program.command_line import package_version
from ddct_plant.scenario.settings import KnownSettings

HEADER, SOURCE, EXAMPLE = 'ddct_mpc.h', 'ddct_mpc.c', 'ddct_mpc_example.c'
LIBRARY = 'ddct_mpc_library.c'
_FILES = (HEADER, SOURCE, EXAMPLE, LIBRARY, INTERFACE)
_PREFIX = 'DDCT_MPC_'
_OURS = Path(__file__).parent / 'c'
_MARK = 'Made by design mpc --export; make it again instead of editing it.'


def export_controller(
    controller: Controller,
    name: str,
    settings: KnownSettings,
    folder: Path,
    *,
    overwrite: bool = False,
) -> list[Path]:
    """
    Write `controller`, which `settings` built, as C into `folder`, with an example.

    Return the paths of the files, which docs/controllers/files.md describes. Raise
    ParameterError when the C lacks a feature of the controller, DdctError when the folder is not
    empty (with `overwrite`: contains a file in the way that is not such an export) or cannot be
    written.
    """
    predictive, observer = exportable(controller, name)
    require_free(folder, _FILES, _MARK, overwrite=overwrite)
    tables = controller_tables(predictive, observer)
    return write_files(folder, _texts(tables, _about(name, settings, predictive.settings)))


def _texts(tables: ControllerTables, about: list[str]) -> dict[str, str]:
    note = remark(about)
    engine = ['engine.c'] if tables.public['COMMANDS_ENGINE'] else []
    # In the order of their use.
    parts = ['doubles.c', 'solver.c', *engine, 'controller.c']
    return {
        HEADER: f'{note}\n'
        + c_parts('ddct_mpc.h').replace('@SIZES@', macros(tables.public, _PREFIX)),
        SOURCE: '\n\n'.join(
            [
                note,
                f'#include <limits.h>\n#include <math.h>\n\n#include "{HEADER}"',
                macros(tables.private),
                constants(tables.arrays),
                c_parts(*parts),
            ]
        ),
        EXAMPLE: f'{note}\n{c_parts("example.c")}',
        LIBRARY: f'{note}\n{c_parts("library.c")}',
        INTERFACE: f'{note}\n{(TEMPLATE / INTERFACE).read_text(encoding="utf-8")}',
    }


def _about(name: str, settings: KnownSettings, chosen: MpcSettings) -> list[str]:
    """Return the remark at the head of every file: origin, settings and version."""
    clutch = chosen.inputs[0]
    slip_limits = (terms.lowest for terms in chosen.outputs if terms.output == SLIP_SPEED)
    lowest_slip = max(slip_limits, default=-math.inf)
    return [
        f'Predictive slip controller {name} with its observer, for a dry dual clutch.',
        _MARK,
        '',
        f'ddct {package_version()}, scenario {settings.scenario.name}, '
        f'architecture {settings.architecture}.',
        f'Prediction over {chosen.prediction_steps} periods, moves over {chosen.control_steps}.',
        f'Clutch torque {clutch.lowest:g} to {clutch.highest:g} N m, its rate at most '
        f'{clutch.rate_n_m_s:g} N m/s (inf is none).',
        f'Slip is softly kept above {lowest_slip:g} rad/s (-inf is no limit).',
        '',
        'Call it every 10 ms (100 Hz). Units are SI: rad/s, rad/s^2, N m. C_load is a torque on',
        'the wheel, all others are on the engine side; a clutch torque above 0 slows the engine',
        'and drives the car. C99, no allocation, no library functions; reentrant. Doubles must be',
        'those of IEEE 754: do not compile it with -ffast-math.',
        '',
        'SPDX-License-Identifier: Apache-2.0',
    ]


def c_parts(*names: str) -> str:
    """Return the text of files of hand-written C, one after another."""
    return '\n'.join((_OURS / name).read_text(encoding='utf-8') for name in names)
