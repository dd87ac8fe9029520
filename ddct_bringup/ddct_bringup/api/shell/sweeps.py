# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plan a sweep, and find its metrics by their names."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from ddct_bringup.api.arguments import base_from, controllers_from
from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.metrics.metric import Metric
from ddct_bringup.run.options import metrics_of
from ddct_bringup.sweep.axis import Axis
from ddct_bringup.sweep.sweep import Sweep
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.registry import controller_label, controller_names, working_controllers


def planned_sweep(
    controllers: Iterable[Any] | Mapping[str, Any] | str | None,
    axes: Sequence[Axis],
    limits: Limits,
    complain: Callable[[str], None],
    **options: Any,
) -> Sweep:
    """
    Return the sweep of controllers, given as for `compare`, over axes, with options of `run`.

    None is every controller that can be built at the first point; `complain` gets a line for each
    other one. Raise DdctError for what cannot be used.
    """
    chosen = controllers_from(controller_names() if controllers is None else controllers)
    base = base_from([controller_label(each) for each in chosen], **options)
    if controllers is None:
        first = base.at({axis.key: axis.values[0] for axis in axes})
        chosen = [*working_controllers(first.known, complain)]
    return Sweep(base, axes, chosen, limits)


def metrics_called(option: str, text: str) -> list[Metric]:
    """Return the metrics that an option names by key or heading; raise ParameterError."""
    by_heading = {metric.symbol: key for key, metric in METRICS.items()}
    names = [by_heading.get(name.strip(), name) for name in text.split(',')]
    return [METRICS[name] for name in metrics_of(option, ','.join(names), METRICS)]
