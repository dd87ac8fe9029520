# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`colcon test` runs the tests of a package."""

import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

from support.declared import ROOT

SMALLEST = 'ddct_reference'


def test_colcon_runs_the_tests_of_a_package(tmp_path: Path) -> None:
    colcon = str(Path(sys.executable).with_name('colcon'))
    program = [colcon, '--log-base', str(tmp_path / 'log'), 'test', '--packages-select', SMALLEST]
    results = ['--test-result-base', str(tmp_path / 'results'), '--return-code-on-test-failure']
    done = subprocess.run([*program, *results], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    (report,) = (tmp_path / 'results').rglob('pytest.xml')
    (suite,) = ElementTree.parse(report).getroot().iter('testsuite')
    assert int(suite.attrib['tests']) > 10
    assert suite.attrib['errors'] == suite.attrib['failures'] == '0'
