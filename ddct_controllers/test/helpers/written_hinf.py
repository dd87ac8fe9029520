# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that `design h-infinity` writes into a folder, beside that of the registry."""

from pathlib import Path

import numpy as np
import pytest

from ddct_controllers.from_file.designed import load_designed
from ddct_controllers.registry import make_controller
from ddct_controllers.synthesised import synthesised_design
from ddct_controllers.workflows.design_program import main
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings


def require_written_as_designed(
    folder: Path, capsys: pytest.CaptureFixture[str], weights: str
) -> None:
    """Require the G_c(z) of the registry to the last bit, and three charts."""
    options = ['h-infinity', '--weights', weights, '--name', 'mine', '--out', str(folder)]
    assert main([*options, '--write-anyway']) == 0
    path = folder / 'mine.yaml'
    assert f'compare --controllers {path}' in capsys.readouterr().out
    settings = RunSettings(KnownSettings(load_scenario('thesis')))
    built = make_controller(str(path), settings.known).linear_model()
    expected = synthesised_design(f'hinf_{weights}').sampled
    for part in 'abcd':
        assert np.array_equal(getattr(built, part), getattr(expected, part))
    provenance = load_designed(str(path)).provenance
    assert provenance['weights']['recipe'] == weights
    assert provenance['lacks']
    assert len(list(folder.glob('mine_*.png'))) == 3
