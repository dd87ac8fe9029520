# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller in a file is found by the nodes of the graph, and leaves the headless run's bag."""

from hashlib import sha256
from pathlib import Path

import pytest
from support.runs import LAYOUTS, bag_bytes, expected, plan, record

from ddct_controllers.from_file.designed import DesignedController
from ddct_controllers.printed import PRINTED_CONTROLLERS


def test_a_relative_file_gives_the_same_bytes_in_one_process_as_headless(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = DesignedController('mine', PRINTED_CONTROLLERS['ls7']).to_yaml()
    Path('any_name.yaml').write_text(text, encoding='utf-8')
    bags = []
    for layout in LAYOUTS[1:]:
        run = plan('any_name.yaml', layout)
        recording = record(run, tmp_path / layout)
        assert recording.trajectory.sha256() == expected(run).sha256(), layout
        assert recording.facts.controller == 'mine'
        assert recording.run_info['/controller']['controller'] == 'mine'
        bags.append(bag_bytes(tmp_path / layout))
    assert all(bag == bags[0] for bag in bags)
    assert not any(b'any_name' in content for content in bags[0].values())


@pytest.mark.nightly
def test_the_class_in_a_relative_python_file_gives_the_same_bytes_in_every_layout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = Path('any_name.py')
    file.write_text(
        'from ddct_controllers.interface import Command, Controller\n'
        'class Mine(Controller):\n'
        '    def reset(self):\n        pass\n'
        '    def update(self, measurement):\n'
        '        return Command(-0.1 * measurement.slip_error_rpm)\n',
        encoding='utf-8',
    )
    bags = []
    for layout in LAYOUTS:
        run = plan(str(file), layout)
        recording = record(run, tmp_path / layout)
        assert recording.trajectory.sha256() == expected(run).sha256(), layout
        told = recording.run_info['/controller']
        assert told['controller'] == 'Mine'
        assert told['controller_file_sha256'] == sha256(file.read_bytes()).hexdigest()
        bags.append(bag_bytes(tmp_path / layout))
    assert all(bag == bags[0] for bag in bags)
    assert not any(b'any_name' in content for content in bags[0].values())
