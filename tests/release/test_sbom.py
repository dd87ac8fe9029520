# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The bill of materials lists every locked package, and the OpenSSL that the wheels bundle."""

import re
from pathlib import Path
from typing import Any

import pytest
from release import sbom

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope='module')
def document() -> dict[str, Any]:
    return sbom.document()


def test_it_has_every_package_of_every_lock_once(document: dict[str, Any]) -> None:
    listed = [(each['name'], each['version']) for each in document['components']]
    assert len(set(listed)) == len(listed)
    for lock in ROOT.glob('requirements*.txt'):
        text = lock.read_text(encoding='utf-8')
        assert set(re.findall(r'^([\w.-]+)==(\S+)', text, re.MULTILINE)) <= set(listed), lock.name


def test_what_only_tests_use_is_no_part_of_the_product(document: dict[str, Any]) -> None:
    scopes = {each['name']: each['scope'] for each in document['components']}
    assert (scopes['numpy'], scopes['fmpy'], scopes['slycot']) == (
        'required',
        'optional',
        'excluded',
    )


def test_the_openssl_of_the_middleware_is_in_it(document: dict[str, Any]) -> None:
    pytest.importorskip('rclpy')
    (package,) = [each for each in document['components'] if each['name'] == 'ros-fastrtps']
    bundled = {each['name']: each['version'] for each in package['components']}
    assert bundled['openssl'] == '1.1.1k'
    assert bundled['fastrtps'] == package['version']


def test_each_component_can_be_referred_to_and_the_text_is_the_same_again(
    document: dict[str, Any],
) -> None:
    inner = [part for each in document['components'] for part in each.get('components', ())]
    references = [each['bom-ref'] for each in (*document['components'], *inner)]
    assert len(set(references)) == len(references)
    assert document['dependencies'][0]['dependsOn'] == references[: len(document['components'])]
    assert sbom.document() == document
    assert (document['bomFormat'], document['specVersion']) == ('CycloneDX', '1.5')
