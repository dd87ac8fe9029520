# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write `least_jerk` as C99 behind the interface of controllers in C."""

from pathlib import Path

from ddct_controllers.c_code.folder import require_free, write_files
from ddct_controllers.c_code.parts import DOUBLES, ENGINE, text_of
from ddct_controllers.c_code.text import constants, macros, remark
from ddct_controllers.from_file.c_library.library import HEADER as INTERFACE
from ddct_controllers.from_file.c_library.library import TEMPLATE
from ddct_controllers.interface import Controller
from ddct_controllers.least_jerk.controller import NAME, LeastJerk
from ddct_controllers.least_jerk.design import LeastJerkDesign
from ddct_controllers.least_jerk.export.numbers import arrays_of, macros_of
from ddct_plant.base.errors import ParameterError
from ddct_plant.program.command_line import package_version
from ddct_plant.scenario.settings import RunSettings

SOURCE, FILE = 'ddct_least_jerk.c', 'least_jerk_in_c.yaml'
_FILES = (SOURCE, INTERFACE, FILE)
_MARK = 'Made by design least-jerk --export; make it again instead of editing it.'
_OURS = Path(__file__).parent / 'c'


def export_least_jerk(
    controller: Controller, settings: RunSettings, folder: Path, *, overwrite: bool = False
) -> list[Path]:
    """
    Write `controller`, which `settings` built, as C into `folder`, with its controller file.

    Return the paths of the files. Raise ParameterError for another controller, DdctError when the
    folder is not empty (with `overwrite`: contains a file in the way that is not such an export)
    or cannot be written.
    """
    if type(controller) is not LeastJerk:
        raise ParameterError(f'only {NAME} itself can be exported so', key=NAME)
    require_free(folder, _FILES, _MARK, overwrite=overwrite)
    note = remark(_about(settings))
    design = controller.design
    texts = {
        SOURCE: '\n\n'.join(
            [
                note,
                f'#include <math.h>\n\n#include "{INTERFACE}"',
                macros(macros_of(design)),
                constants(arrays_of()),
                text_of(_parts(design)),
            ]
        ),
        INTERFACE: f'{note}\n{(TEMPLATE / INTERFACE).read_text(encoding="utf-8")}',
        FILE: f'# {_MARK}\nname: {NAME}_in_c\nc_library: {{file: ddct_least_jerk.so}}\n',
    }
    return write_files(folder, texts)


def _about(settings: RunSettings) -> list[str]:
    return [
        'Clutch controller least_jerk for a dry dual clutch.',
        _MARK,
        '',
        f'ddct {package_version()}, scenario {settings.scenario.name}, clutch {settings.clutch}.',
        '',
        'Call it every 10 ms (100 Hz). Units are SI: rad/s, rad/s^2, N m. C99, no allocation; the',
        'only library function is sqrt. Doubles must be those of IEEE 754: compile it with',
        '-ffp-contract=off and without -ffast-math, and its results are those of Python.',
        '',
        'cc -std=c99 -O2 -ffp-contract=off -shared -fPIC ddct_least_jerk.c -lm \\',
        '    -o ddct_least_jerk.so',
        '',
        'SPDX-License-Identifier: Apache-2.0',
    ]


def _parts(design: LeastJerkDesign) -> list[Path]:
    """Return the files of the hand-written C, in the order of their use."""
    engine = [ENGINE, _OURS / 'engine.c'] if design.shaping_steps else []
    return [DOUBLES, _OURS / 'estimates.c', _OURS / 'plan.c', *engine, _OURS / 'controller.c']
