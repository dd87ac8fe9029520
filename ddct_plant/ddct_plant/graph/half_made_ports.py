# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Ports in shared memory that a node was making when it was killed (Fast DDS on Linux).

A later node that opens such a port would wait without a limit for its completion. Ports that are
complete survive the death of their owners.
"""

import contextlib
import os
import struct
import time
from pathlib import Path

SHARED_MEMORY = Path('/dev/shm')
LEAST_AGE_S = 1.0
"""Age in s at which a port that is not complete has no maker any more; one takes microseconds."""
_POLL_S = 0.01
_BASE, _PER_DOMAIN = 7400, 250
"""Number of the first port of domain 0, and of ports of a domain (DDSI-RTPS, 9.6.1.1)."""
_OF_ALL_DOMAINS = range(7000, _BASE)
"""Ports that Fast DDS numbers in the order in which they are free, whatever the domain."""
_COMPLETE = struct.pack('=I', 2)
"""First bytes of a complete segment: a state of Boost.Interprocess, 0 and 1 before it."""


def remove_half_made_ports(domain: int) -> None:
    """Remove ports for nodes of a domain that no process completes; wait for those being made."""
    first = _BASE + _PER_DOMAIN * domain
    numbers = (*_OF_ALL_DOMAINS, *range(first, first + _PER_DOMAIN))
    names = {f'fastrtps_port{number}' for number in numbers}
    found: set[str] = set()
    # Not by glob: there may be a thousand files, and each node looks at its start.
    with contextlib.suppress(FileNotFoundError), os.scandir(SHARED_MEMORY) as entries:
        found = {entry.name for entry in entries}
    for port in map(SHARED_MEMORY.joinpath, names & found):
        # Its maker may remove it meanwhile, or be another user.
        with contextlib.suppress(OSError):
            while not _is_complete(port):
                if not 0.0 <= time.time() - port.stat().st_mtime < LEAST_AGE_S:
                    port.unlink()
                    break
                time.sleep(_POLL_S)


def _is_complete(port: Path) -> bool:
    with port.open('rb') as file:
        return file.read(len(_COMPLETE)) == _COMPLETE
