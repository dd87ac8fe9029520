# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The specifications that come with the package; cheap to import."""

from pathlib import Path

PACKAGED = Path(__file__).parents[1] / 'packaged'
"""Folder of the specifications that come with the package."""


def packaged_specs() -> list[str]:
    """Return the names of the specifications that come with the package."""
    return sorted(file.stem for file in PACKAGED.glob('*.yaml'))
