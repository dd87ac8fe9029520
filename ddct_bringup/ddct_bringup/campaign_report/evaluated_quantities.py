# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quantities that a campaign evaluates: those of which less is better."""

from collections.abc import Iterable
from dataclasses import replace

from ddct_bringup.campaign.rows import CRITERION
from ddct_bringup.metrics.catalogue import CRITERIA, FURTHER, TABLE_5_1
from ddct_bringup.metrics.metric import Criterion, Metric
from ddct_plant.program.table import Quantity


def quantities_of(
    metrics: Iterable[Metric], criteria: Iterable[Criterion]
) -> tuple[Quantity, ...]:
    """Return the quantities of which less is better, by column, those of criteria last."""
    return (
        *(metric for metric in metrics if metric.smaller_is_better),
        *(
            replace(criterion, key=f'{CRITERION}{criterion.key}')
            for criterion in criteria
            if not criterion.metric
        ),
    )


QUANTITIES = quantities_of((*TABLE_5_1, *FURTHER), CRITERIA)
"""Metrics and further criteria by column; for each a smaller magnitude is better."""
