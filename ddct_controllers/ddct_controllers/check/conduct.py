# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Checks that torques depend on the measurements alone: torques, prints, state, reset."""

import sys
from types import FunctionType

import numpy as np

from ddct_controllers.check.subject import CheckFailedError, Subject
from ddct_controllers.check.trial import more_slip, replay
from ddct_controllers.check.watch import watched
from ddct_controllers.interface import Controller
from ddct_controllers.places import place_of_method

PLAIN = (bool, int, float, str, list, tuple, dict, set, np.ndarray, np.generic, type(None))
"""Types of values that are compared by their text."""


def answers(subject: Subject) -> str:
    """Check that every update returns a command that the loop can use."""
    closed = subject.closed_loop
    return f'{len(closed.update_s)} commands, each with finite torques and a status of text'


def prints(subject: Subject) -> str:
    """Check that nothing is written to standard output, which is for the results of programs."""
    printed = subject.printed
    if printed.text:
        lines = printed.text.splitlines()
        raise CheckFailedError(
            f'{printed.place}: it printed {len(lines)} lines to standard output, which programs '
            f'use for results, the first {lines[0]!r}: give it as a `status` of the Command'
        )
    return 'it printed nothing'


def own_state(subject: Subject) -> str:
    """Check that two objects used in turn do not disturb each other: no state is shared."""
    before = _shared(subject.sample, subject.package)
    alone = subject.torques
    if subject.compiled:
        return 'each run of compiled code has a process of its own'
    changed = [
        name
        for name, value in _shared(subject.sample, subject.package).items()
        if before.get(name) != value
    ]
    one, other = subject.make(), subject.make()
    beside = np.zeros_like(alone)
    for row, period in zip(beside, subject.measurements, strict=True):
        row[:] = replay(one, [period])[0]
        replay(other, [period], more_slip)
    if np.array_equal(alone, beside):
        return 'a second object that runs beside it changes nothing'
    if changed:
        raise CheckFailedError(
            f'a second object changes what it answers, as both share {", ".join(changed)}: '
            f'make that an attribute of self, in __init__ or reset '
            f'({place_of_method(subject.sample, "__init__")})'
        )
    if np.array_equal(alone, replay(subject.make(), subject.measurements)):
        raise CheckFailedError(
            'a second object that runs beside it changes what it answers: they share an object '
            f'or a file; keep all state in the object ({place_of_method(one, "__init__")})'
        )
    return 'objects share nothing'


def determinism(subject: Subject) -> str:
    """Check that the same measurements give the same torques, whatever the clock reads."""
    with watched(subject.package) as called:
        again = replay(subject.make(), subject.measurements)
    different = np.flatnonzero((again != subject.torques).any(axis=1))
    if not different.size:
        return f'{len(again)} answers again to the last bit, with the clock moved'
    step = int(different[0])
    places = '; '.join(f'it calls {what} in {place}' for what, place in called.items())
    raise CheckFailedError(
        f'a new object with the same measurements asks for {again[step, 0]:.6g} instead of '
        f'{subject.torques[step, 0]:.6g} N m at step {step}: use the measurement alone '
        f'(its step is k, 10 ms each) and seeded random numbers; '
        f'{places or "it calls no clock and no random number that is known here"}'
    )


def reset(subject: Subject) -> str:
    """Check that an object behaves after reset like a new one."""
    controller = subject.make()
    replay(controller, subject.measurements)
    controller.reset()
    again = replay(controller, subject.measurements)
    different = np.flatnonzero((again != subject.torques).any(axis=1))
    if different.size:
        step = int(different[0])
        raise CheckFailedError(
            f'after reset it asks for {again[step, 0]:.6g} instead of '
            f'{subject.torques[step, 0]:.6g} N m at step {step}{_left_after_reset(subject)}: set '
            f'all state anew in {place_of_method(controller, "reset")}'
        )
    return 'after reset it answers as a new object'


def _shared(controller: Controller, package: str) -> dict[str, str]:
    """Return by name the plain values that objects of the controller's classes share."""
    owners: dict[str, object] = {}
    for each in type(controller).__mro__:
        if each.__module__.partition('.')[0] == package:
            owners[each.__module__] = sys.modules[each.__module__]
            owners[each.__qualname__] = each
    found = {}
    for owner_name, owner in owners.items():
        for name, value in vars(owner).items():
            if isinstance(value, FunctionType):
                found[f'the defaults of {owner_name}.{name}'] = repr(value.__defaults__)
            elif isinstance(value, PLAIN) and not name.startswith('__'):
                found[f'{owner_name}.{name}'] = repr(value)
    return found


def _left_after_reset(subject: Subject) -> str:
    """Return the plain attributes that reset does not restore, as part of a sentence, or ''."""
    used = subject.make()
    replay(used, subject.measurements)
    used.reset()
    left = [
        f'self.{name} is {vars(used).get(name)!r}, of a new object {value!r}'
        for name, value in vars(subject.make()).items()
        if isinstance(value, PLAIN) and repr(vars(used).get(name)) != repr(value)
    ]
    return f' ({"; ".join(left)})' if left else ''
