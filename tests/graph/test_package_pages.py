# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of each package names the topics and parameters of its nodes, as they declare them."""

import re
from pathlib import Path

import pytest
from support.documented import ROOT, package_page

PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')


@pytest.mark.parametrize('package', PACKAGES)
def test_the_example_without_ros_runs(package: str, capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = re.findall(r'```python\n(.*?)```', package_page(package), re.DOTALL)
    exec(compile(example, f'{package}/README.md', 'exec'), {})
    assert re.search(r'-?\d+\.\d', capsys.readouterr().out)


@pytest.mark.parametrize('package', PACKAGES)
@pytest.mark.parametrize('name', ['README.md', 'CHANGELOG.md'])
def test_each_link_of_a_package_page_leads_to_a_file(package: str, name: str) -> None:
    file = ROOT / package / name
    links = re.findall(r'\]\(([^)#]+)[^)]*\)', file.read_text(encoding='utf-8'))
    assert links
    assert [link for link in links if not Path(file.parent, link).is_file()] == []
