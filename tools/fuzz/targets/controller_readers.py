# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Readers of controller files, with a good file of every kind that YAML names.

A file of Python is no target: it is run, so that a damaged one may do anything. The library that a
file names is read for its digest alone, as its code is loaded with the first run.
"""

from pathlib import Path

from support.fmu import CONTROLLER

from ddct_controllers.from_file.with_options import with_options_text
from ddct_controllers.registry import controller_spec
from fuzz.reader import Reader
from fuzz.targets.fmu_readers import (
    DESCRIPTION,
    FMU,
    descriptions,
    fmus,
    read_description,
    read_fmu,
)

_LIBRARY = 'libmine.so'
_WITH_LIBRARY = f"""\
name: mine
c_library: {{file: {_LIBRARY}, parameters: {{gain_n_m_per_rpm: -0.1, limit: 60}}}}
"""
_TEMPLATES = Path(__file__).resolve().parents[3] / 'docs' / 'templates'


def controller_readers() -> list[Reader]:
    """Return the readers of controller files and of the FMU that one names."""
    linear = [file.read_bytes() for file in sorted(_TEMPLATES.glob('transfer*.yaml'))]
    texts = (
        with_options_text('mine', 'ls8', {'gain': -0.02}),
        with_options_text('mine', 'other.yaml', {'proportional_gain': 0.2}),
        _WITH_LIBRARY,
        CONTROLLER,
    )
    files = (*linear, *(each.encode() for each in texts))
    return [
        Reader('controller', 'mine.yaml', _controller, files),
        Reader('fmu_description', DESCRIPTION, read_description, descriptions()),
        Reader('fmu', FMU, read_fmu, fmus()),
    ]


def _controller(file: Path) -> object:
    """Read a controller file beside the files that good ones name."""
    other = with_options_text('other', 'pi', {'integral_gain': 0.3})
    (file.parent / 'other.yaml').write_text(other, encoding='utf-8')
    (file.parent / _LIBRARY).write_bytes(b'\x7fELF')
    (file.parent / FMU).write_bytes(fmus()[0])
    return controller_spec(str(file))
