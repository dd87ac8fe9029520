# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Folder of what programs keep on the disk to compute it once."""

import os
from pathlib import Path

_VARIABLE = 'DDCT_CACHE'
"""Environment variable with the folder of the cache; empty for none."""


def cache_folder(kind: str) -> Path | None:
    """Return the folder of what is kept of a kind, None where nothing is to be kept."""
    given = os.environ.get(_VARIABLE)
    if given is not None:
        return Path(given) / kind if given else None
    home = os.environ.get('XDG_CACHE_HOME') or Path.home() / '.cache'
    return Path(home) / 'ddct' / kind
