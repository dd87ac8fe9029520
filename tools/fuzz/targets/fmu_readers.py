# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Inputs that are an FMU, or its description: what reads them, and good ones."""

import io
import zipfile
from pathlib import Path

from support.fmu import CONTROLLER, PLATFORMS, VERSIONS, description

from ddct_controllers.registry import controller_spec

DESCRIPTION = 'modelDescription.xml'
FMU = 'pi.fmu'
_BINARIES = tuple(f'binaries/{platform}/pi.so' for platform in PLATFORMS.values())


def descriptions() -> tuple[bytes, ...]:
    """Return the description of a PI for each version of FMI."""
    return tuple(description(version).encode() for version in VERSIONS)


def fmus() -> tuple[bytes, ...]:
    """Return FMUs with these descriptions; their binaries are empty, as none is loaded here."""
    return tuple(map(_fmu, descriptions()))


def read_description(file: Path) -> object:
    """Read a controller file whose FMU has this description."""
    (file.parent / FMU).write_bytes(_fmu(file.read_bytes()))
    return read_fmu(file.parent / FMU)


def read_fmu(file: Path) -> object:
    """Read a controller file for this FMU."""
    controller = file.parent / 'mine.yaml'
    controller.write_text(CONTROLLER, encoding='utf-8')
    return controller_spec(str(controller))


def _fmu(text: bytes) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, 'w') as file:
        file.writestr(DESCRIPTION, text)
        for name in _BINARIES:
            file.writestr(name, b'')
    return content.getvalue()
