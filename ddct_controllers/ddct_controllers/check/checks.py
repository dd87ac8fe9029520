# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""All checks in their order, and their run."""

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ddct_controllers.check import conduct, installation, loops, signals
from ddct_controllers.check.subject import CheckFailedError, CheckSkippedError, Subject
from ddct_controllers.check.watch import OutputMonitor
from ddct_controllers.registry import separately
from ddct_plant.base.errors import FOREIGN_FAILURES, ParameterError
from ddct_plant.program.own_process import ProcessEndedError
from ddct_plant.scenario.settings import KnownSettings

PASS, FAIL, SKIPPED = 'pass', 'fail', 'skipped'


@dataclass(frozen=True)
class Outcome:
    """Result of one check: a line of the report."""

    name: str
    state: str
    """Result: PASS, FAIL or SKIPPED."""
    detail: str
    """Measured values; for a failure also the place of the error and the remedy."""


@dataclass(frozen=True)
class Check:
    """One check, under the name that the report gives it."""

    name: str
    run: Callable[[Subject], str]
    """Function that returns the measured values; raises CheckFailedError or CheckSkippedError."""
    after: Sequence[str] = ()
    """Names of the checks that must have passed before this one runs."""


_MADE, _RUNS, _SAME = ('constructor',), ('answers', 'update time'), ('determinism',)
CHECKS = (
    Check('entry point', installation.entry_point),
    Check('installation', installation.installation, ('entry point',)),
    Check('constructor', installation.constructor, ('entry point',)),
    Check('options', installation.options, _MADE),
    Check('answers', conduct.answers, _MADE),
    Check('update time', loops.update_time, ('answers',)),
    Check('state', conduct.own_state, _RUNS),
    Check('determinism', conduct.determinism, ('state',)),
    Check('reset', conduct.reset, _SAME),
    Check('NaN', signals.not_a_number, (*_SAME, 'reset')),
    Check('spike', signals.spike, _SAME),
    Check('saturation', signals.saturation, _SAME),
    Check('preview', signals.preview, _SAME),
    Check('sign', signals.sign, _RUNS),
    Check('unit', loops.unit, _RUNS),
    Check('rate', loops.rate, _RUNS),
    Check('linear model', loops.linear_model, _RUNS),
    Check('stability', loops.stability, _RUNS),
    Check('prints', conduct.prints, _MADE),
)


def check_controller(name: str, settings: KnownSettings) -> list[Outcome]:
    """
    Return an outcome per check of CHECKS for a controller of the registry or in a file.

    Raise ParameterError for plates that stick: a locked clutch does not answer the checks' steps.
    """
    if settings.stick_slip:
        raise ParameterError(
            f'scenario {settings.scenario.name} has the clutch stick_slip, whose plates lock, and '
            'the checks judge how plates answer that slip: choose one with the clutch linear, '
            'such as thesis',
            key='clutch',
        )
    printed = OutputMonitor()
    subject = Subject(name, settings, printed)
    outcomes: dict[str, Outcome] = {}
    causes: dict[str, str] = {}
    with contextlib.redirect_stdout(printed):
        for check in CHECKS:
            missing = [each for each in check.after if outcomes[each].state != PASS]
            if missing:  # if that was skipped itself: the first failure
                causes[check.name] = first = causes.get(missing[0], missing[0])
                state, detail = SKIPPED, f'the check {first!r} must pass first'
            else:
                state, detail = _separate_result(check, subject)
            outcomes[check.name] = Outcome(check.name, state, detail)
    return list(outcomes.values())


def _separate_result(check: Check, subject: Subject) -> tuple[str, str]:
    """Return state and detail of a check; compiled code that ends its process fails it alone."""
    if not subject.compiled:
        return _result(check, subject)
    try:
        state, detail, trials = separately(
            subject.spec, lambda _: (*_result(check, subject), subject.trials())
        )
    except ProcessEndedError as error:
        return FAIL, str(error)
    vars(subject).update(trials)
    return state, detail


def _result(check: Check, subject: Subject) -> tuple[str, str]:
    try:
        return PASS, check.run(subject)
    except CheckSkippedError as reason:
        return SKIPPED, str(reason)
    except CheckFailedError as failure:
        return FAIL, str(failure)
    except FOREIGN_FAILURES as error:  # the controller's own, whatever it is
        return FAIL, str(subject.failure(error))
