# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Conditions that only a gear shift has, for headings: the handover and the off-going wear."""

from ddct_plant.scenario.settings import RunSettings


def shift_conditions(settings: RunSettings) -> dict[str, str]:
    """Return the text of each such condition by the key of its setting; none without a shift."""
    if not settings.shift:
        return {}
    return {
        'handover': f'handover {settings.known.handover_name}',
        'off_going_wear_gain': f'off-going wear gain {settings.case.off_going_wear_gain:g}',
    }
