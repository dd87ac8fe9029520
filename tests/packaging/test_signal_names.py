# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals are addressed by name: no module of the product takes a value of a row by its place."""

import ast
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from syntax import tree_of

from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.signals.topics import all_signals, quantities

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
ROWS = {signal.name for signal in all_signals() if signal.parts}
"""Names of the signals with several quantities."""
OF_TRAJECTORIES = {signal.name for signal in all_signals() if signal.size != 1}
"""Names of the signals that have several values at each tick of a trajectory."""


def subscripts(file: Path) -> Iterator[tuple[str, ast.Subscript]]:
    """Yield each subscript of an attribute or of a key, with the name of the attribute or key."""
    for node in ast.walk(tree_of(file)):
        if not isinstance(node, ast.Subscript):
            continue
        if isinstance(node.value, ast.Attribute):
            yield node.value.attr, node
        elif isinstance(node.value, ast.Subscript):
            key = node.value.slice
            if isinstance(key, ast.Constant) and isinstance(key.value, str):
                yield key.value, node


def takes_place(index: ast.expr) -> bool:
    """Return whether an index of several axes takes the place of one value in the last one."""
    return isinstance(index, ast.Tuple) and isinstance(index.elts[-1], ast.Constant | ast.Name)


def by_place(file: Path) -> list[str]:
    return [
        f'{file}:{node.lineno}: {ast.unparse(node)}'
        for name, node in subscripts(file)
        if name in ROWS or (name in OF_TRAJECTORIES and takes_place(node.slice))
    ]


@pytest.mark.parametrize('package', PACKAGES)
def test_no_quantity_is_taken_out_of_a_signal_by_its_place(package: str) -> None:
    files = (ROOT / package / package).rglob('*.py')
    assert [found for file in files for found in by_place(file)] == []


@pytest.mark.parametrize(
    'line',
    [
        'run.joint_speed[:, 3]',
        'outputs.joint_speed[0]',
        'run.joint_effort[..., 2]',
        'run.signals["joint_speed"][:, place]',
        'run.slip_reference[..., 0]',
        'run.clutch_torque[:, 0]',
    ],
)
def test_such_a_line_is_found(line: str, tmp_path: Path) -> None:
    file = tmp_path / 'some.py'
    file.write_text(line, encoding='utf-8')
    assert by_place(file) == [f'{file}:1: {ast.unparse(ast.parse(line))}']


def test_a_quantity_of_a_signal_with_several_is_an_attribute_of_a_trajectory() -> None:
    speeds = np.arange(12.0).reshape(3, 4)
    run = Trajectory.of_columns({'joint_speed': speeds.tolist(), 'slip_speed': [0.0, 0.0, 0.0]})
    assert np.array_equal(run.engine_speed, speeds[:, 0])
    assert np.array_equal(run.driveshaft_speed, speeds[:, 3])
    assert run.wheel_effort is None
    assert run.sensed_engine_speed is None
    with pytest.raises(AttributeError, match='there is no signal engine_sped'):
        run.engine_sped  # noqa: B018


def test_many_runs_have_the_same_names() -> None:
    speeds = np.arange(24.0).reshape(2, 3, 4)
    assert np.array_equal(Trajectory({'joint_speed': speeds}).wheel_speed, speeds[..., 2])


def test_the_value_at_the_tick_is_the_first_of_a_row_over_time() -> None:
    torque = np.arange(33.0).reshape(3, 11)
    run = Trajectory.of_columns({'clutch_torque': torque.tolist(), 'slip_speed': [5.0, 4.0, 3.0]})
    assert np.array_equal(run.at_tick('clutch_torque'), torque[:, 0])
    assert np.array_equal(run.at_tick('slip_speed'), run.slip_speed)
    assert np.array_equal(run.clutch_torque, torque)
    assert run.at_tick('actuator_torque') is None


def test_no_quantity_has_the_name_of_another_or_of_a_signal_with_several() -> None:
    names = [name for signal in all_signals() for name in signal.quantities]
    assert len(set(names)) == len(names)
    assert not set(names) & ROWS
    assert set(names) == set(quantities())
