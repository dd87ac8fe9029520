"""Sweeps from Python: every controller over the values of keys."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ddct_bringup.api.runs import base_from, controllers_from, pandas_module, plain
from ddct_bringup.campaign.rows import result_row
from ddct_bringup.sweep.axis import Axis, axis, axis_of
from ddct_bringup.sweep.sweep import Sweep
from ddct_bringup.verdict.limits import load_limits
from ddct_controllers.registry import controller_label


def sweep(
    controllers: str | Iterable[Any] | Mapping[str, Any],
    over: Mapping[str, str | Iterable[Any]],
    *,
    limits: str | Path | None = None,
    **options: Any,
) -> Any:
    """
    Run controllers over values, headless on all cores; return a pandas DataFrame.

    `controllers` are given as for `compare`, `options` as for `run`. `over` has by key the values,
    or the text 'START:STOP:COUNT'; of several keys every combination runs. A row per run holds
    the controller, the values under their keys, every metric, `valid` and `reason`,
    `verdict_state`, `verdict_limits`, and the criteria as `criterion.NAME`.
    """
    chosen = controllers_from(controllers)
    base = base_from([controller_label(each) for each in chosen], **options)
    judged_by = load_limits(limits)
    planned = Sweep(base, [_axis(key, over[key]) for key in over], chosen, judged_by)
    with planned.runs() as runs:
        return pandas_module().DataFrame([result_row(each.entry, each.varied) for each in runs])


def _axis(key: str, values: str | Iterable[Any]) -> Axis:
    if isinstance(values, str):
        return axis_of(f'{key}={values}')
    return axis(key, [plain(value) for value in values])
