# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""CONTRIBUTING tells how to add each kind of thing, and names no file that is not there."""

import re
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / 'CONTRIBUTING.md').read_text(encoding='utf-8')


def test_every_path_is_there() -> None:
    named = re.findall(r'`((?:ddct_\w+|docs|tests|tools)/[\w./]+)`', PAGE)
    linked = re.findall(r'\]\((?!https?:)([\w./]+)\)', PAGE)
    assert len(named) >= 6
    assert [path for path in (*named, *linked) if not (ROOT / path).exists()] == []


def test_the_workflow_runs_the_checks_of_this_page_on_each_python() -> None:
    workflow = yaml.safe_load((ROOT / '.github/workflows/check.yml').read_text(encoding='utf-8'))
    job = workflow['jobs']['check']
    assert job['steps'][-1]['run'] == '.ci/run'
    assert job['strategy']['matrix']['python'] == ['3.11', '3.12', '3.13']
