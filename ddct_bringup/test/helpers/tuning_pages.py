# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Commands on the page of a tuning, what they compared, and the parts of such a tuning."""

from pathlib import Path

from printed_commands import printed_commands

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.tuning.tuned_names import PAGE
from ddct_plant.scenario.settings import RunSettings

FILE = 'name: mine\nwith_options: {controller: pi, options: {%s}}\n'
VARIED = {
    'samples': 1,
    'vary': {
        'wear_gain': {'distribution': 'uniform', 'low': 0.9, 'high': 1.1},
        'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1400, 'high': 1600},
    },
}
ENGAGED = {'engaged': {'at_least': 0.5}}


def commands_of(folder: Path) -> tuple[str, str]:
    """Return the commands of the page in a folder: to compare, and to verify."""
    compare, verify = printed_commands((folder / PAGE).read_text(encoding='utf-8'))
    return compare, verify


def compared_settings(folder: Path) -> dict[str, RunSettings]:
    """Return the settings of the runs in a folder by the name of the controller."""
    bags = {path.name: read_bag(path) for path in folder.iterdir() if any(path.glob('*.mcap'))}
    return {name: bag.settings for name, bag in bags.items() if bag.settings}
