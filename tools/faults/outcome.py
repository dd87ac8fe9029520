# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What was observed of a run under a fault, and the outcomes that can be stated for a case."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from support.runs import expected

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.validity import why_invalid
from ddct_plant.base.errors import DdctError

NEVER = 10**9


@dataclass
class Observed:
    """What a run did under a fault."""

    error: str = ''
    """First error of the run, in one line; empty for none."""
    fault_step: int = 0
    """Step at which the fault began; NEVER for a fault that has not happened."""
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


def _accounted_for(seen: Observed) -> bool:
    """Return whether a recording of other values has a reason for them."""
    reason = seen.missed or seen.safe or not seen.complete
    return not seen.error and seen.steps >= 0 and bool(seen.same_hash or reason)


RUNS_ON = Stated(
    'ends; other values than undisturbed only with missed steps, a safe state, or not valid',
    lambda seen: _accounted_for(seen) and _no_false_result(seen),
)
NOT_VALID = Stated(
    'a recording that is not valid', lambda seen: not seen.error and not seen.complete
)

REFUSED = Stated(
    'a recording that is refused with the topic and the stamp of a lost message',
    lambda seen: not seen.error and 'has no message at step' in seen.refusal,
)


def named(*words: str, within_s: float = math.inf) -> Stated:
    """
    Return the outcome that the run ends with an error with all of these words.

    With `within_s` the recording ends within this time of the run after the fault.
    """
    limit = '' if math.isinf(within_s) else f' within {within_s:g} s'

    def met(seen: Observed) -> bool:
        in_time = seen.steps - seen.fault_step <= 100 * within_s
        return all(word in seen.error for word in words) and in_time and _no_false_result(seen)

    return Stated(f'error{limit} naming {" and ".join(words)}', met)


def either(*stated: Stated) -> Stated:
    """Return the outcome that one of several comes true."""
    return Stated(
        ', or '.join(each.text for each in stated), lambda seen: any(s.met(seen) for s in stated)
    )


NO_REPLY = named('no ', ' for stamp')
WITHIN_S = 0.3
"""Timeout of a clutch torque, and time for the signal on a busy machine."""


def safe_state(*nodes: str, within_s: float = WITHIN_S, stopped: str = '') -> Stated:
    """
    Return the outcome that all of these nodes enter their safe state.

    The run may end with an error that names the topic for which it has waited at its last step, or
    the node that was `stopped`: a busy machine may need longer than `PATIENCE_S` for its end.
    """
    limit = round(100 * within_s)

    def met(seen: Observed) -> bool:
        steps = [seen.safe.get(f'/{node}', 10**6) for node in nodes]
        # A message of the step before the fault may be the last one that came in time.
        after = [step - seen.fault_step for step in steps]
        in_time = all(-1 <= each <= limit for each in after)
        waited = ' no ' in f' {seen.error}' and ' for stamp ' in seen.error
        named_node = bool(stopped) and f'node {stopped} has been paused' in seen.error
        well = not seen.error or waited or named_node
        return in_time and well and not seen.complete

    return Stated(f'safe state of {" and ".join(nodes)} within {within_s:g} s, named', met)
