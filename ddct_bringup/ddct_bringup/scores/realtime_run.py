"""Whether a real-time run counts, and what it says of itself in one line."""

import math

from ddct_bringup.bag.reader import Recording
from ddct_plant.base.timebase import START_NS
from ddct_plant.graph.topics import CLUTCH_TORQUE, ENGINE_TORQUE, HOLDING_TORQUE, LOAD_TORQUE

MISS_TOLERANCE = 0.01
"""
Share of the steps that may have held a torque. A machine busy with other work missed 6 of 2500,
which the figures do not show; a node that stands still for half a second misses 50 of 300.
"""


def missed_steps(recording: Recording) -> int:
    """
    Return at how many steps a torque was held.

    The driveline counts them; replies that only the bag lacks count too, since its signals hold
    the last value there.
    """
    torques = (ENGINE_TORQUE, LOAD_TORQUE, CLUTCH_TORQUE, HOLDING_TORQUE)
    held = (recording.missed.get(topic.name, 0) for topic in torques)
    return max(recording.realtime.missed_steps, *held)


def safe_state(recording: Recording) -> str:
    """Return which node went to its safe state and at which scenario time, or ''."""
    states = sorted(recording.realtime.safe_states.items(), key=lambda each: each[1])
    return ', '.join(f'{node} at {(stamp - START_NS) / 1e9:g} s' for node, stamp in states)


def why_not_real_time(recording: Recording) -> list[str]:
    """Return why a real-time run that came to its end does not count; empty if it does."""
    reasons = []
    missed, steps = missed_steps(recording), recording.trajectory.steps
    if missed > MISS_TOLERANCE * steps:
        reasons.append(
            f'{missed} of {steps} steps held a torque for want of a reply, more than '
            f'{math.floor(MISS_TOLERANCE * steps)} (1 %)'
        )
    if states := safe_state(recording):
        reasons.append(f'safe state entered by {states}')
    return reasons


def realtime_summary(recording: Recording) -> str:
    """Return misses, worst lateness and safe state in one line."""
    lateness = recording.realtime.worst_lateness_us
    late = 'unknown' if lateness is None else f'{lateness / 1e3:.2f} ms'
    return (
        f'{missed_steps(recording)} of {recording.trajectory.steps} steps missed, worst lateness '
        f'{late}, safe state: {safe_state(recording) or "none"}'
    )
