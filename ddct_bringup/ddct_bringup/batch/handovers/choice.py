# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The handovers that a batch supports, and the one-line reason for another."""

from collections.abc import Hashable, Mapping, Sequence

from ddct_bringup.batch.handovers.adaptive import AdaptiveHandovers
from ddct_bringup.batch.handovers.laws import (
    ModelHandovers,
    SlipHandovers,
    StackedHandover,
    TimedHandovers,
)
from ddct_plant.scenario.settings import KnownSettings

STACKED_HANDOVERS: Mapping[str, type[StackedHandover]] = {
    'timed': TimedHandovers,
    'slip': SlipHandovers,
    'model': ModelHandovers,
    'adaptive': AdaptiveHandovers,
}
"""Stacked handovers by name."""


def why_no_handover(known: KnownSettings) -> str:
    """Return in one line why the handover of a shift is not in a batch, empty if it is."""
    if known.handover in STACKED_HANDOVERS:
        return ''
    return f'the handover is {known.handover_name}, code of a third party'


def handover_kind(known: KnownSettings) -> Hashable:
    """Return what shifts share whose handovers are stacked."""
    scenario = known.scenario
    limited = scenario.engine_limits is not None
    return known.handover, scenario.control_start_step, limited


def make_handovers(known: Sequence[KnownSettings]) -> StackedHandover:
    """Return the handovers of R shifts of one kind."""
    return STACKED_HANDOVERS[known[0].handover](known)
