# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The kind of machine on which figures were measured: processor, cores and versions."""

import os
import platform
import re
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

PACKAGES = ('numpy', 'scipy', 'daqp', 'osqp', 'control', 'rclpy')


@dataclass(frozen=True)
class Machine:
    """Kind of a machine; figures of equal kinds are kept in one file."""

    processor: str
    """Name, family and model of the processor."""
    cores: int
    """Number of cores that this process may use."""
    python: str
    """Version of Python, such as 3.11."""
    packages: dict[str, str]
    """Versions of the packages whose speed shows in the figures, by name."""

    @property
    def slug(self) -> str:
        """Name of the file of its history, without the extension."""
        text = f'{self.processor} {self.cores} cores python {self.python}'
        return re.sub(r'[^a-z0-9.]+', '_', f'{text} numpy {self.packages["numpy"]}'.lower())

    def as_json(self) -> dict[str, Any]:
        """Return the fields by name."""
        return asdict(self)


def this_machine(cpuinfo: Path = Path('/proc/cpuinfo')) -> Machine:
    """Return the kind of this machine."""
    return Machine(
        _processor(cpuinfo),
        len(os.sched_getaffinity(0)),
        '.'.join(platform.python_version_tuple()[:2]),
        {name: _version(name) for name in PACKAGES},
    )


def _processor(cpuinfo: Path) -> str:
    try:
        lines = cpuinfo.read_text(encoding='utf-8').splitlines()
    except OSError:
        return platform.machine()
    values: dict[str, str] = {}
    for line in lines:
        name, _, value = line.partition(':')
        values.setdefault(name.strip(), value.strip())
    name = values.get('model name', platform.machine())
    numbers = [f'{key} {values[source]}' for key, source in _NUMBERS.items() if source in values]
    return ' '.join([name, *numbers])


_NUMBERS = {'family': 'cpu family', 'model': 'model'}
"""Keys of /proc/cpuinfo, by their names here."""


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return 'none'
