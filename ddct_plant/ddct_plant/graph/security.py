# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Request for DDS security (SROS 2): refused where the middleware was built without it.

ROS itself then runs unsecured without a message, unless ROS_SECURITY_STRATEGY is Enforce.
"""

import mmap
import os
import sys
from pathlib import Path

from ddct_plant.base.errors import DdctError

REQUEST = 'ROS_SECURITY_ENABLE'
"""Environment variable that requests security where it is `true`."""
_MIDDLEWARE = 'RMW_IMPLEMENTATION'
_FAST_DDS = tuple(
    f'{folder}/lib{name}.so' for folder in ('lib', 'lib/*') for name in ('fastrtps', 'fastdds')
)
"""Where Fast DDS, the default middleware, has its library, below a prefix of ROS."""
_PLUGIN = b'builtin.PKI-DH'
"""Name of the plugin for authentication; only a library built with security has it."""


def require_security_if_asked() -> None:
    """Raise DdctError where security is requested and Fast DDS cannot give it."""
    if os.environ.get(REQUEST) != 'true' or 'fast' not in os.environ.get(_MIDDLEWARE, 'fast'):
        return
    libraries = _fast_dds()
    if not any(_has_security(library) for library in libraries):
        found = ', '.join(map(str, libraries)) or 'not found'
        raise DdctError(
            f'{REQUEST} is true, but this Fast DDS has no DDS security ({found}): use ROS 2 from '
            'apt (docs/use/security.md), or unset it to run without',
            key=REQUEST,
        )


def _fast_dds() -> list[Path]:
    """Return the libraries of Fast DDS, the one that is loaded first."""
    prefixes = [*os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep), sys.prefix]
    found = (
        library
        for prefix in filter(None, prefixes)
        for pattern in _FAST_DDS
        for library in sorted(Path(prefix).glob(pattern))
    )
    return list(found)[:1]


def _has_security(library: Path) -> bool:
    with library.open('rb') as file, mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ) as content:
        return content.find(_PLUGIN) >= 0
