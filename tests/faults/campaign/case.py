# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A case of the fault campaign, what must follow from it, and what was observed."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from support.runs import expected, plan

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.validity import why_invalid
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import time_of_step

MODES = ('lockstep', 'realtime')
SHORT, IN_REAL_TIME, LONG = 100, 160, 400
"""Steps of a run; in real time a fault of half a second must be over before the end."""
ENDED_BY_FAULT = 3000
"""Steps of a run in lock-step that its fault ends: it must not be over before the fault."""
INSTANTS = ('start', 'middle', 'end')
MIDDLE = 68
"""Step at which a fault in the middle begins; control begins at step 60, or 30 in the shift."""
MOST_TRIES = 3
"""Times that a case is tried where a busy machine was too late for it."""
CLUTCHES = (1, 2)


def run_of(mode: str, clutches: int, steps: int = SHORT) -> RunPlan:
    """Return the run that a fault disturbs: of an engagement, or of a gear shift."""
    seconds = time_of_step(steps)
    if clutches == 1:
        return plan('ls8', duration_s=seconds, mode=mode)
    return plan('pi', scenario='upshift', duration_s=seconds, clutch='stick_slip', mode=mode)


@dataclass
class Observed:
    """What a run did under a fault."""

    error: str = ''
    """First error of the run, in one line; empty for none."""
    fault_step: int = 0
    planned: int = 0
    """Number of steps of the run."""
    same_hash: bool = False
    """Whether the recording is that of the undisturbed run, to its end."""
    refusal: str = ''
    """Why the recording is refused; empty for one that can be read."""
    steps: int = -1
    """Last recorded step; -1 without a recording that can be read."""
    complete: bool = False
    """Whether the recording claims to be that of a whole, valid run."""
    missed: int = 0
    safe: dict[str, int] = field(default_factory=dict)
    """Step at which a node entered its safe state, by its name."""
    left: list[str] = field(default_factory=list)
    """What was left behind: processes, shared memory."""

    def read(self, folder: Path, run: RunPlan) -> None:
        """Read the recording of `run` in a folder, if it can be read."""
        self.planned = run.steps
        try:
            recording = read_bag(folder)
        except DdctError as error:
            self.refusal = str(error).rpartition(f'{folder}')[2].lstrip(': ')
            return
        self.steps = recording.trajectory.steps
        self.complete = not why_invalid(recording)
        self.same_hash = recording.trajectory.sha256() == expected(run).sha256()
        if recording.realtime is not None:
            self.missed = recording.realtime.missed_steps
            self.safe = {
                node: (stamp - 10**9) // 10**7
                for node, stamp in recording.realtime.safe_states.items()
            }

    def summary(self) -> str:
        """Return the outcome in a few words."""
        states = [f'safe state of {node} at {step / 100:g} s' for node, step in self.safe.items()]
        missed = [f'{self.missed} missed'] if self.missed else []
        ends = [self.error] if self.error else ['same hash' if self.same_hash else 'other values']
        if self.refusal and not self.error:
            return '; '.join([f'recording refused: {self.refusal}', *self.left])
        early = 0 <= self.steps < self.planned and not self.error
        recorded = [f'recorded to step {self.steps}, not valid'] if early else []
        return '; '.join([*ends, *states, *missed, *recorded, *self.left])


@dataclass(frozen=True)
class Stated:
    """Outcome that is stated for a case."""

    text: str
    met: Callable[[Observed], bool]


def _whole(seen: Observed) -> bool:
    return not seen.error and seen.same_hash


def _no_false_result(seen: Observed) -> bool:
    """Return whether an early end is no complete recording."""
    return seen.steps == seen.planned or not seen.complete


SAME = Stated('same hash', _whole)
RUNS_ON = Stated(
    'ends; what is missing is counted, safe states are named',
    lambda seen: not seen.error and seen.steps >= 0 and _no_false_result(seen),
)

REFUSED = Stated(
    'a recording that is refused with the topic and the stamp of a lost message',
    lambda seen: not seen.error and 'has no message at step' in seen.refusal,
)


def named(*words: str) -> Stated:
    """Return the outcome that the run ends with an error with all of these words."""
    return Stated(
        f'error naming {" and ".join(words)}',
        lambda seen: all(word in seen.error for word in words) and _no_false_result(seen),
    )


def either(*stated: Stated) -> Stated:
    """Return the outcome that one of several comes true."""
    return Stated(
        ', or '.join(each.text for each in stated), lambda seen: any(s.met(seen) for s in stated)
    )


def safe_state(*nodes: str, within_s: float) -> Stated:
    """Return the outcome that all of these nodes enter their safe state, and the run ends well."""
    limit = round(100 * within_s)

    def met(seen: Observed) -> bool:
        steps = [seen.safe.get(f'/{node}', 10**6) for node in nodes]
        return all(step - seen.fault_step <= limit for step in steps) and not (
            seen.complete or seen.error
        )

    return Stated(f'safe state of {" and ".join(nodes)} within {within_s:g} s, named', met)


@dataclass(frozen=True)
class Case:
    """One fault, where and when it happens, what must follow, and how it is tried."""

    fault: str
    target: str
    instant: str
    mode: str
    clutches: int
    stated: Stated
    attempt: Callable[['Case', Path], Observed]
    """Function that causes the fault in a run recorded in a new folder."""
    steps: int = SHORT
    """N, the number of steps of the run."""

    @property
    def name(self) -> str:
        """Name of the case, unique in the campaign."""
        clutches = 'one clutch' if self.clutches == 1 else 'two clutches'
        return ', '.join(
            filter(None, [self.fault, self.target, self.instant, self.mode, clutches])
        )

    @property
    def run(self) -> RunPlan:
        """The run that the fault disturbs."""
        return run_of(self.mode, self.clutches, self.steps)

    @property
    def begin(self) -> int:
        """Step at which the fault begins."""
        places = {'start': 0, 'middle': MIDDLE, 'end': self.steps - self.steps // 8}
        return places.get(self.instant, MIDDLE)

    def came_too_late(self, seen: Observed) -> bool:
        """Return whether the run was over before the fault, or the machine too slow."""
        return self.mode == 'realtime' or (seen.same_hash and not seen.error)
