# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A release is refused unless each of its files is whole; `make release` tries the wheels."""

import shutil
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from release.build import (
    PACKAGES,
    PLACEHOLDER,
    ROOT,
    ReleaseError,
    name_maintainer,
    require_address,
    require_content,
    require_metadata,
)
from release.trial import example_of_readme

WHOLE = ['ddct_plant/py.typed', 'ddct_plant-1.dist-info/LICENSE', 'share/ddct_plant/package.xml']
METADATA = """\
Summary: The plant
License: Apache-2.0
Requires-Python: >=3.11
Description-Content-Type: text/markdown

# ddct_plant
"""


@pytest.mark.parametrize('missing', WHOLE)
def test_an_archive_without_types_licence_or_package_xml_is_refused(missing: str) -> None:
    require_content('ddct_plant.whl', WHOLE, 'ddct_plant')
    with pytest.raises(ReleaseError):
        require_content(
            'ddct_plant.whl', [name for name in WHOLE if name != missing], 'ddct_plant'
        )


def test_an_archive_with_tests_is_refused() -> None:
    with pytest.raises(ReleaseError):
        require_content('a.tar.gz', [*WHOLE, 'ddct_plant/test/test_units.py'], 'ddct_plant')


@pytest.mark.parametrize('line', METADATA.splitlines()[:4])
def test_incomplete_metadata_are_refused(line: str) -> None:
    require_metadata('ddct_plant.whl', METADATA)
    with pytest.raises(ReleaseError):
        require_metadata('ddct_plant.whl', METADATA.replace(f'{line}\n', ''))


def test_an_address_that_does_not_exist_is_refused() -> None:
    with pytest.raises(ReleaseError):
        require_metadata('a.whl', f'Maintainer-email: somebody@ddct.invalid\n{METADATA}')


@pytest.mark.parametrize('package', PACKAGES)
def test_the_address_of_the_maintainer_takes_the_place_of_the_placeholder(
    package: str, tmp_path: Path
) -> None:
    file = tmp_path / 'package.xml'
    shutil.copy(ROOT / package / 'package.xml', file)
    name_maintainer(file, 'somebody@uni-somewhere.edu')
    (maintainer,) = ElementTree.parse(file).findall('maintainer')
    assert maintainer.get('email') == 'somebody@uni-somewhere.edu'
    assert 'invalid' not in file.read_text(encoding='utf-8')
    with pytest.raises(ReleaseError, match='leave MAINTAINER out'):
        name_maintainer(file, 'another@uni-somewhere.edu')


@pytest.mark.parametrize(
    'address', [PLACEHOLDER, 'me', 'me@localhost', 'me@host.example', 'me@example.org', 'a b@c.de']
)
def test_an_address_that_reaches_nobody_is_refused(address: str) -> None:
    require_address('first.last+ddct@mail.uni-somewhere.edu')
    with pytest.raises(ReleaseError):
        require_address(address)


def test_the_trial_runs_the_class_of_the_readme() -> None:
    assert 'class Proportional(Controller)' in example_of_readme()
