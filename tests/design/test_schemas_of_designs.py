# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What the programs of designs write is as its schema."""

import json

import pytest
from by_schema import require_schema

from ddct_controllers.workflows.design_program import main


@pytest.mark.slow
@pytest.mark.parametrize(
    ('arguments', 'name'),
    [
        (['plant'], 'plant'),
        (['margins', '--controllers', 'pi'], 'frequency'),
        pytest.param(['loop-shaping'], 'loop_shaping_thesis', marks=pytest.mark.nightly),
        pytest.param(
            ['h-infinity', '--weights', 'sampled'], 'h_infinity', marks=pytest.mark.nightly
        ),
    ],
)
def test_what_a_design_writes_is_as_its_schema(
    arguments: list[str], name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*arguments, '--json', '-']) == 0
    require_schema(name, json.loads(capsys.readouterr().out))
