# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`colcon test` runs the tests of a package; `make test` runs them all in one session."""

from pathlib import Path

import pytest
from support.declared import PACKAGES, ROOT, setup_of


@pytest.mark.parametrize('package', PACKAGES)
def test_colcon_knows_that_the_tests_of_a_package_need_pytest(package: str) -> None:
    """Without this it looks for tests of unittest, and finds none."""
    assert 'pytest' in setup_of(package)['extras_require']['test']
    assert list(Path(ROOT, package, 'test').rglob('test_*.py'))
