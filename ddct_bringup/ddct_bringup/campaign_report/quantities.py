"""The quantities that a campaign is judged by: the metrics, and the other criteria."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ddct_bringup.campaign.rows import CRITERION
from ddct_bringup.verdict.criteria import CRITERIA
from ddct_bringup.verdict.metric_figures import FURTHER, TABLE_5_1
from ddct_plant.program.table import Figure

_NOT_JUDGED = ('steps',)
"""Of these more is not worse."""
QUANTITIES = (
    *(figure for figure in (*TABLE_5_1, *FURTHER) if figure.key not in _NOT_JUDGED),
    *(
        replace(criterion, key=f'{CRITERION}{criterion.key}')
        for criterion in CRITERIA
        if not criterion.metric
    ),
)
"""By the names of their columns. Less of a magnitude is better, for each of them."""


def quantities_in(columns: Mapping[str, np.ndarray]) -> list[Figure]:
    """Return those of which a run has a value."""
    return [
        each
        for each in QUANTITIES
        if each.key in columns and not np.isnan(columns[each.key]).all()
    ]
