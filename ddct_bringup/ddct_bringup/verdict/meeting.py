"""When the plates of a clutch that sticks meet and part, by the exact events of the driveline."""

from collections.abc import Iterator

from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.models import driveline
from ddct_plant.models.driveline import LOCK, PHASES, RELEASE, PhaseEvent

SLIPPING, LOCKED = PHASES.index(driveline.SLIPPING), PHASES.index(driveline.LOCKED)
"""Values of `clutch_phase`."""


def events_of(trajectory: Trajectory, kind: str, after: int = 0) -> Iterator[PhaseEvent]:
    """Yield the events of a kind after a step, in the order of time; none of a linear clutch."""
    periods = (trajectory.phase_events or ())[after + 1 :]
    return (event for events in periods for event in events if event.kind == kind)


def locked_at(trajectory: Trajectory, step: int) -> bool:
    """Say whether the plates are locked at a step; False for a linear clutch."""
    phase = trajectory.clutch_phase
    return phase is not None and len(phase) > step and phase[step] == LOCKED


def first_lock(trajectory: Trajectory, start: int) -> PhaseEvent | None:
    """Return the first lock after step `start`; None without, and where locked there already."""
    if locked_at(trajectory, start):
        return None
    return next(events_of(trajectory, LOCK, after=start), None)


def first_meeting(trajectory: Trajectory, start: int) -> tuple[int, PhaseEvent] | None:
    """
    Return the first lock or reversal after step `start`, and the step at the end of its period.

    None without, and where the slip is zero at `start`.
    """
    if trajectory.steps < start or trajectory.slip_speed[start] == 0.0:
        return None
    return next(
        (
            (step, event)
            for step, events in enumerate(trajectory.phase_events or ())
            for event in events
            if step > start and event.kind != RELEASE
        ),
        None,
    )
