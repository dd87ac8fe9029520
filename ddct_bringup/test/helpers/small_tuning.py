# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Small tunings of the PI, whose linear runs take milliseconds."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.tuning.conduct import carry_out_tuning
from ddct_bringup.tuning.report.folder import write_tuning
from ddct_bringup.tuning.specification.spec import tuning_spec_of
from ddct_bringup.tuning.tuning import Tuning, tuning_of
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import controller_spec

CONTENT: dict[str, Any] = {
    'parameters': {
        'proportional_gain': {'low': 0.05, 'high': 0.5, 'scale': 'log'},
        'integral_gain': {'low': 0.01, 'high': 1.0, 'scale': 'log'},
    },
    'objectives': {
        'engagement_time_s': {'statistic': 'worst'},
        'torsion_speed_std_rpm': {'statistic': 'worst'},
    },
    'constraints': {'engaged': {'at_least': 0.9}},
    'campaign': {
        'scenario': 'thesis',
        'random': {
            'samples': 5,
            'vary': {'wear_gain': {'distribution': 'uniform', 'low': 0.7, 'high': 1.3}},
        },
    },
    'trials': 20,
    'seed': 3,
}
"""Specification with two objectives, of which trials end early."""
Make = Callable[..., Tuning]


def campaign_of(samples: int) -> dict[str, Any]:
    """Return the campaign of `CONTENT` with another number of cases."""
    campaign = CONTENT['campaign']
    return {**campaign, 'random': {**campaign['random'], 'samples': samples}}


def tuning(controller: str = 'pi', folder: Path | None = None, **changes: Any) -> Tuning:
    """Return the tuning of `CONTENT` with other values of its keys."""
    content = {**CONTENT, **changes}
    spec = tuning_spec_of(content, folder or Path.cwd(), controller_spec(controller))
    return tuning_of(controller, spec, packaged_limits())


def leave_out_pictures(patch: pytest.MonkeyPatch) -> None:
    """Draw no chart on pages of tunings and benchmarks, half of the time of a small one."""
    patch.setattr('ddct_bringup.documents.bokeh_charts.draw_chart', lambda chart: [])


def made_tuning(out: Path, **changes: Any) -> Path:
    """Carry out a small tuning, and return its folder."""
    made = tuning(**changes)
    write_tuning(out, carry_out_tuning(made, out, workers=2), workers=2)
    return out
