# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The digest of the code covers everything that rows depend on: modules, and YAML files."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from in_this_process import in_this_process
from refusals import refused

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.conduct import carry_out
from ddct_bringup.campaign.shards import require_code
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.manifest import code
from ddct_bringup.manifest.code import code_digest
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import DdctError


@pytest.fixture
def sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Return a folder in place of the packages: a module and a YAML file in each."""
    for package in ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup'):
        (tmp_path / package / 'room').mkdir(parents=True)
        (tmp_path / package / 'module.py').write_text('GAIN = 1.0\n', encoding='utf-8')
        (tmp_path / package / 'room' / 'values.yaml').write_text('gain: 1.0\n', encoding='utf-8')
        (tmp_path / package / 'page.css').write_text('p {}\n', encoding='utf-8')
    monkeypatch.setattr(code, 'files', lambda package: tmp_path / package)
    code_digest.cache_clear()
    yield tmp_path
    code_digest.cache_clear()


def digest_after(file: Path, text: str) -> str:
    file.write_text(text, encoding='utf-8')
    code_digest.cache_clear()
    return code_digest()


@pytest.mark.parametrize('name', ['module.py', 'room/values.yaml'])
@pytest.mark.parametrize('package', ['ddct_plant', 'ddct_bringup'])
def test_a_module_and_a_yaml_file_of_every_package_belong_to_the_code(
    sources: Path, package: str, name: str
) -> None:
    before = code_digest()
    assert digest_after(sources / package / name, 'gain: 2.0\n') != before
    with pytest.raises(DdctError, match='other sources'):
        require_code(before)


def test_files_that_no_row_depends_on_are_not_in_the_digest(sources: Path) -> None:
    before = code_digest()
    assert digest_after(sources / 'ddct_bringup' / 'page.css', 'p { color: red }\n') == before


def test_resume_refuses_a_folder_from_before_a_yaml_file_changed(sources: Path) -> None:
    content = {'controllers': ['pi'], 'grid': {'wear_gain': [1.0], 'duration_s': [0.7]}}
    campaign = Campaign(spec_of(content, sources))
    out = sources / 'out'
    with in_this_process():
        carry_out(campaign, packaged_limits(), out)
        digest_after(sources / 'ddct_plant' / 'room' / 'values.yaml', 'gain: 2.0\n')
        with refused(DdctError, 'code'):
            carry_out(campaign, packaged_limits(), out, resume=True)
