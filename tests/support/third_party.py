# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Make entry points visible as if a third party's package were installed."""

import os
import tomllib
from collections.abc import Mapping
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parent.parent / 'example_controller'
SUPPORT = Path(__file__).parent
GROUP = 'ddct.controllers'


def example_entry_points() -> dict[str, str]:
    """Return the entry points that the example package declares."""
    project = tomllib.loads((EXAMPLE / 'pyproject.toml').read_text(encoding='utf-8'))['project']
    return project['entry-points'][GROUP]


def install(
    monkeypatch: pytest.MonkeyPatch,
    site: Path,
    code: Path,
    entry_points: Mapping[str, str],
    group: str = GROUP,
) -> None:
    """Write a distribution into the new folder `site`; put it and `code` on every Python path."""
    information = site / 'third_party-1.0.dist-info'
    information.mkdir(parents=True)
    (information / 'METADATA').write_text(
        'Metadata-Version: 2.1\nName: third-party\nVersion: 1.0\n', encoding='utf-8'
    )
    lines = [f'[{group}]', *(f'{name} = {target}' for name, target in entry_points.items())]
    (information / 'entry_points.txt').write_text('\n'.join(lines) + '\n', encoding='utf-8')
    paths = [str(site), str(code), os.environ.get('PYTHONPATH', '')]
    monkeypatch.setenv('PYTHONPATH', os.pathsep.join(filter(None, paths)))
    monkeypatch.syspath_prepend(code)
    monkeypatch.syspath_prepend(site)


def install_broken(monkeypatch: pytest.MonkeyPatch, site: Path) -> None:
    """Make the controllers of `broken_controllers` visible, and one that cannot be imported."""
    answers = ('not_a_number', 'infinite', 'bare_number', 'text', 'raising', 'bad_status')
    names = (*answers, 'leaving', 'slow', 'bad_linear_model', 'no_controller', 'nothing')
    targets = {name: f'support.broken_controllers:make_{name}' for name in names}
    targets['absent'] = 'no_such_package.controllers:make'
    install(monkeypatch, site, SUPPORT.parent, targets)
