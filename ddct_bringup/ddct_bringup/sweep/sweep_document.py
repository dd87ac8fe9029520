"""What `ddct sweep --json` writes."""

from collections.abc import Sequence
from typing import Any

from ddct_bringup.sweep.sweep import Sweep, SweptRun
from ddct_controllers.registry import controller_label

SCHEMA_VERSION = 1


def sweep_document(sweep: Sweep, runs: Sequence[SweptRun]) -> dict[str, Any]:
    """Return the axes, the limits, and a row per run: its place, then as in `scores.json`."""
    return {
        'schema_version': SCHEMA_VERSION,
        'over': [
            {'key': axis.key, 'unit': axis.unit, 'values': list(axis.values)}
            for axis in sweep.axes
        ],
        'controllers': [controller_label(each) for each in sweep.controllers],
        'limits': sweep.limits.origin,
        'rows': [
            {
                'over': dict(run.varied),
                **{key: value for key, value in run.entry.items() if key != 'bag'},
            }
            for run in runs
        ],
    }
