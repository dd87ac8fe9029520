# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tune a controller into a folder, from its specification to the page."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ddct_bringup.tuning.conduct import carry_out_tuning
from ddct_bringup.tuning.report.folder import write_tuning
from ddct_bringup.tuning.result import TuningResult
from ddct_bringup.tuning.specification.other_car import in_car
from ddct_bringup.tuning.specification.spec import read_tuning_spec, tuning_spec_of
from ddct_bringup.tuning.tuning import tuning_of
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import controller_spec


def tune_into(
    controller: str,
    spec: str | Mapping[str, Any],
    out: Path,
    *,
    car: str | None = None,
    left_out: Callable[[str, str], None] = lambda scenario, reason: None,
    workers: int | None,
    resume: bool,
    stopped: Callable[[], bool] = lambda: False,
) -> TuningResult:
    """
    Tune a controller, by name or file, into the folder `out`; return the content of `front.json`.

    `spec` is a file, the name of a packaged one, or its content as a mapping; files that a mapping
    names are relative to the working directory. With a `car`, by name or file, all cases have that
    car, and `left_out` gets each scenario that it cannot drive, with the reason. Raise DdctError
    for what cannot be used, KeyboardInterrupt when `stopped()` becomes true: `resume` goes on with
    what is done.
    """
    known = controller_spec(controller)
    if isinstance(spec, Mapping):
        given = tuning_spec_of(spec, Path.cwd(), known)
    else:
        given = read_tuning_spec(spec, known)
    if car is not None:
        given, reasons = in_car(given, car, known)
        for scenario, reason in reasons.items():
            left_out(scenario, reason)
    tuning = tuning_of(controller, given, packaged_limits())
    trials = carry_out_tuning(tuning, out, workers=workers, resume=resume, stopped=stopped)
    return write_tuning(out, trials, workers=workers, stopped=stopped)
