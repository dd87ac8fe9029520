# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What the packages declare in their setup.py."""

import runpy
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
ROS = {
    *('builtin_interfaces', 'diagnostic_msgs', 'geometry_msgs'),
    *('rcl_interfaces', 'rclpy', 'rosgraph_msgs', 'sensor_msgs', 'std_msgs', 'trajectory_msgs'),
}
"""Modules of ROS packages, which package.xml names as they are and PyPI does not have."""


def setup_of(package: str) -> dict[str, Any]:
    """Return what a package's setup.py hands to setuptools."""
    import setuptools

    given: dict[str, Any] = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(setuptools, 'setup', lambda **options: given.update(options))
        patch.chdir(ROOT / package)
        runpy.run_path('setup.py')
    return given


def declared_to_pip(package: str) -> tuple[set[str], set[str]]:
    """
    Return what a package's setup.py requires, and what it has as extras for its users.

    Extras of what it requires are left out: `portalocker[win32]` is portalocker.
    """
    given = setup_of(package)
    extras = given['extras_require'].items()
    required = {name.partition('[')[0] for name in given['install_requires']} - {'setuptools'}
    return required, {name for key, names in extras if key != 'test' for name in names}
