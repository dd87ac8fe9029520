# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tune a controller from Python."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ddct_bringup.api.shell.tunings import tune_into
from ddct_bringup.campaign.arrow_columns import read_parquet
from ddct_bringup.tuning.result import FrontEntry, TuningResult
from ddct_bringup.tuning.tables import NUMBER, TRIALS
from ddct_bringup.tuning.tuned_names import BEST


class TuningResults(NamedTuple):
    """Results of a finished tuning."""

    front: Any
    """
    pandas DataFrame with a row per trial of the front, by its number.

    Columns: parameters, objectives as `development.NAME` and `held_out.NAME`, and `file`.
    """
    trials: Any
    """
    pandas DataFrame with a row per trial, by its number: the columns of `trials.parquet`.

    Parameters, objectives, `constraints.NAME`, `state`, `reason`, and `runs` computed.
    """
    result: TuningResult
    """Content of `front.json`."""
    best: Path
    """Controller file of the best trial."""


def tune(
    controller: str,
    spec: str | Path | Mapping[str, Any],
    out: str | Path,
    *,
    car: str | Path | None = None,
    workers: int | None = None,
    resume: bool = False,
) -> TuningResults:
    """
    Tune a controller, by name or file, into the folder `out`, as `ddct tune` does.

    `spec` is a file, the name of a packaged one, or its content as a mapping; files that a mapping
    names are relative to the working directory. With a `car` all cases have that car, and are
    drawn around its values.
    """
    import pandas

    folder = Path(out)
    given = spec if isinstance(spec, Mapping) else str(spec)
    named = None if car is None else str(car)
    result = tune_into(controller, given, folder, car=named, workers=workers, resume=resume)
    front = pandas.DataFrame(_front_rows(result.front)).set_index('number')
    tried = read_parquet(folder / TRIALS).to_pandas().set_index(NUMBER)
    return TuningResults(front, tried, result, folder / BEST)


def _front_rows(front: Sequence[FrontEntry]) -> list[dict[str, float | str | None]]:
    return [
        {
            'number': each.number,
            **each.parameters,
            **{
                f'{name}.{key}': value
                for name, figures in (
                    ('development', each.development),
                    ('held_out', each.held_out),
                )
                if figures
                for key, value in figures.objectives.items()
            },
            'file': each.file,
        }
        for each in front
    ]
