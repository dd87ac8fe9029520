# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plugin of pytest: what was imported of the project's packages comes from the scratch copy."""

import os
import sys
from pathlib import Path

import pytest

VARIABLE = 'DDCT_ONLY_THE_COPY'
"""Environment variable with the folder of the copy."""
FOREIGN = 70
"""Exit code when a package was imported from elsewhere."""


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish() -> None:
    """End the session with an error when something was imported from elsewhere."""
    copy = Path(os.environ[VARIABLE]).resolve()
    imported = {
        name: Path(module.__file__).resolve()
        for name, module in sys.modules.items()
        if name.startswith('ddct_') and getattr(module, '__file__', None)
    }
    foreign = [
        f'{name} from {path}' for name, path in imported.items() if copy not in path.parents
    ]
    if foreign:
        pytest.exit(f'imported from outside {copy}: {", ".join(foreign)}', returncode=FOREIGN)
