# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Records of benches are kept by kind of machine, and the docs read what the bench writes."""

import json
from dataclasses import replace
from pathlib import Path

from bench.skeleton.comparison import Point
from bench.skeleton.history import append, record_of
from bench.skeleton.machine import Machine, this_machine
from bench.skeleton.rounds import Result

MACHINE = Machine('Processor X', 2, '3.11', {'numpy': '2.4.0', 'rclpy': '7.1'})
RESULTS = [
    Result('graph', 'the chain', (1.41234, 1.2, 1.3), 1.5),
    Result('chain, nodes 8', 'the chain', (1.0,), point=Point('nodes', 8)),
    Result('page', 'a bare page', reason='no browser'),
]


def test_a_record_has_every_ratio_its_bound_and_why_one_is_missing() -> None:
    record = record_of(RESULTS, MACHINE, 3, 'abc', 0.5)
    assert record['machine']['processor'] == 'Processor X'
    assert record['figures'] == [
        {
            'name': 'graph', 'reference': 'the chain', 'outcome': 'met', 'bound': 1.5,
            'ratio': 1.3, 'rounds': [1.412, 1.2, 1.3],
        },
        {
            'name': 'chain, nodes 8', 'reference': 'the chain', 'outcome': '', 'bound': None,
            'ratio': 1.0, 'rounds': [1.0], 'over': {'nodes': 8},
        },
        {
            'name': 'page', 'reference': 'a bare page', 'outcome': 'not measured', 'bound': None,
            'reason': 'no browser',
        },
    ]  # fmt: skip


def test_each_kind_of_machine_has_a_file_with_a_line_for_each_record(tmp_path: Path) -> None:
    record = record_of(RESULTS, MACHINE, 3, '', 0.5)
    files = {
        append(record, machine, tmp_path / 'speed')
        for machine in (
            MACHINE,
            MACHINE,
            replace(MACHINE, cores=8),
            replace(MACHINE, python='3.12'),
        )
    }
    assert sorted(file.name for file in files) == [
        'processor_x_2_cores_python_3.11_numpy_2.4.0.jsonl',
        'processor_x_2_cores_python_3.12_numpy_2.4.0.jsonl',
        'processor_x_8_cores_python_3.11_numpy_2.4.0.jsonl',
    ]
    lines = (tmp_path / 'speed' / min(file.name for file in files)).read_text().splitlines()
    assert [json.loads(line) for line in lines] == [record, record]


def test_the_kind_of_a_machine_is_that_of_its_processor_file(tmp_path: Path) -> None:
    cpuinfo = tmp_path / 'cpuinfo'
    cpuinfo.write_text('processor\t: 0\ncpu family\t: 26\nmodel\t\t: 2\nmodel name\t: AMD EPYC\n')
    assert this_machine(cpuinfo).processor == 'AMD EPYC family 26 model 2'
    assert this_machine(tmp_path / 'none').processor
