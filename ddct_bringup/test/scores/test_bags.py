# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Bags are found in the named folder, wherever that folder is."""

from pathlib import Path

import pytest

from ddct_bringup.scores.bags import bags_in, find_bags
from ddct_plant.base.errors import DdctError


def bag(folder: Path) -> Path:
    folder.mkdir(parents=True)
    (folder / f'{folder.name}_0.mcap').write_bytes(b'')
    return folder


def test_bags_below_a_hidden_folder_are_found_when_a_folder_in_it_is_named(tmp_path: Path) -> None:
    pi = bag(tmp_path / '.cache' / 'runs' / 'pi')
    assert find_bags(tmp_path / '.cache' / 'runs') == [pi]
    assert find_bags(tmp_path / '.cache') == [pi]
    assert bags_in([tmp_path / '.cache']) == [(pi, tmp_path / '.cache')]


def test_hidden_folders_below_the_named_one_do_not_count(tmp_path: Path) -> None:
    pi = bag(tmp_path / 'runs' / 'pi')
    bag(tmp_path / 'runs' / '.trash' / 'pi')
    bag(tmp_path / 'runs' / 'deep' / '.old' / 'ls8')
    assert find_bags(tmp_path / 'runs') == [pi]
    with pytest.raises(DdctError, match='no .mcap file in this folder or below it'):
        find_bags(tmp_path / 'runs' / 'deep')
