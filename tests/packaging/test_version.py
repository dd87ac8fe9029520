# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The version stands in package.xml, the same in all four packages; everything else tells that."""

import importlib
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
import yaml
from support.declared import setup_of

from ddct_plant.graph.node_reports import run_info_pairs

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
PROGRAMS = (
    *(f'ddct_bringup.programs.{name}' for name in ('bringup', 'compare', 'live', 'report')),
    *(f'ddct_bringup.programs.{name}' for name in ('score', 'thesis')),
    'ddct_controllers.workflows.design_program',
    'ddct_bringup.identification.identify',
)


def version_of(package: str) -> str:
    version = ElementTree.parse(ROOT / package / 'package.xml').findtext('version')
    assert version
    return version


def test_the_four_packages_have_one_version() -> None:
    assert len({version_of(package) for package in PACKAGES}) == 1


@pytest.mark.parametrize('package', PACKAGES)
def test_setup_takes_the_version_from_package_xml(package: str) -> None:
    text = (ROOT / package / 'setup.py').read_text(encoding='utf-8')
    assert version_of(package) not in text
    assert setup_of(package)['version'] == version_of(package)


def test_the_newest_version_of_the_changelog_is_this_one() -> None:
    changelog = (ROOT / 'CHANGELOG.md').read_text(encoding='utf-8')
    assert re.findall(r'^## (\d\S*)$', changelog, re.MULTILINE)[0] == version_of('ddct_plant')


@pytest.mark.parametrize('module', PROGRAMS)
def test_every_program_prints_the_version(module: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        importlib.import_module(module).main(['--version'])
    assert end.value.code == 0
    assert capsys.readouterr().out.strip() == version_of('ddct_plant')


def test_nodes_publish_the_version_on_run_info() -> None:
    pairs = run_info_pairs('load')
    assert pairs['version'] == version_of('ddct_plant')


def test_the_citation_has_the_version_and_the_thesis_of_the_readme() -> None:
    citation = yaml.safe_load((ROOT / 'CITATION.cff').read_text(encoding='utf-8'))
    assert citation['version'] == version_of(PACKAGES[0])
    (thesis,) = citation['references']
    assert f'*{thesis["title"]}*' in (ROOT / 'README.md').read_text(encoding='utf-8')
