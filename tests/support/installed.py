# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Programs as colcon installs them."""

from pathlib import Path

import pytest


def installed(package: str, program: str) -> str:
    """Return the path of an installed program, or skip the test without a sourced workspace."""
    index = pytest.importorskip('ament_index_python.packages', reason='no ROS environment')
    try:
        prefix = index.get_package_prefix(package)
    except (index.PackageNotFoundError, OSError):  # OSError: nothing at all is sourced
        pytest.skip(f'{package} is not installed: build the workspace and source install/setup.*')
    return str(Path(prefix) / 'lib' / package / program)
