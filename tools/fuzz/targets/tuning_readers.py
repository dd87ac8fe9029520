# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Readers of tunings: specifications, each for its controller, the manifest and the trials."""

import tempfile
from collections.abc import Iterator, Sequence
from functools import partial
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path

import pyarrow as pa

from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.campaign.columns import parquet_bytes, schema_of
from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.tuning.plan import RecordedTuning, TuningPlan
from ddct_bringup.tuning.specification.packaged_specs import packaged_specs
from ddct_bringup.tuning.specification.spec import TuningSpec, read_tuning_spec, tuning_spec_of
from ddct_bringup.tuning.study import JOURNAL, TuningStudy, read_trials
from ddct_bringup.tuning.tables import RUNS, all_runs, rows_by_trial
from ddct_bringup.tuning.trial import Trial
from ddct_bringup.tuning.tuning import Tuning
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_controllers.registry import controller_spec
from ddct_plant.files.json_records import json_text, read_json
from fuzz.reader import Reader

_CONTROLLERS = {'mpc_thesis': 'mpc3', 'pi_launches': 'pi'}
"""Controllers of the packaged specifications."""
_SPEC = {
    'parameters': {'proportional_gain': {'low': 0.05, 'high': 0.5}},
    'objectives': {'engagement_time_s': {'statistic': 'worst'}},
    'constraints': {'engaged': {'at_least': 0.9}},
    'campaign': {
        'scenario': 'thesis',
        'random': {
            'samples': 2,
            'vary': {'wear_gain': {'distribution': 'uniform', 'low': 0.7, 'high': 1.3}},
        },
    },
    'trials': 2,
}


def tuning_readers(folder: Path) -> list[Reader]:
    """Return the readers of a tuning's files; `folder` is that of its specification."""
    spec = tuning_spec_of(_SPEC, folder, controller_spec('pi'))
    tuning = Tuning(Judged.of('pi'), spec, packaged_limits())
    schema = schema_of(tuning.campaign.spec)
    trials = [
        Trial(
            number,
            {'proportional_gain': 0.1 + 0.1 * number},
            pa.Table.from_pylist([_row(tuning, number)], schema),
            {'corner': 1.5},
        )
        for number in range(2)
    ]
    rows = parquet_bytes(all_runs(trials, tuning.campaign.spec))
    return [
        *_specifications(),
        Reader('tuning_plan', 'plan.json', _tuning, (_plan(tuning),)),
        Reader('tuning_trials', JOURNAL, _trials, (_journal(spec, trials),)),
        Reader('tuning_runs', RUNS, _runs, (rows,)),
    ]


def _specifications() -> Iterator[Reader]:
    for name in packaged_specs():
        read = partial(_specification, controller_spec(_CONTROLLERS[name]))
        text = (files('ddct_bringup.tuning') / 'packaged' / f'{name}.yaml').read_bytes()
        yield Reader(f'tuning_{name}', 'mine.yaml', read, (text,))


def _specification(controller: ControllerSpec[Controller], file: Path) -> object:
    return read_tuning_spec(str(file), controller)


def _row(tuning: Tuning, number: int) -> dict[str, object]:
    """Return a row of which most columns have no value."""
    columns = dict.fromkeys(schema_of(tuning.campaign.spec).names)
    return {**columns, 'index': number, 'state': 'engaged', 'engagement_time_s': 0.7}


def _plan(tuning: Tuning) -> bytes:
    """Return a plan with a made-up version of Optuna, which need not be there to read it."""
    return json_text(TuningPlan.of(tuning, '4.0', InputFiles())).encode()


def _tuning(file: Path) -> object:
    """Return the digest of the cases of the tuning of a plan."""
    recorded = RecordedTuning(read_json(TuningPlan, file), CodeOrigin.here())
    return recorded.tuning(file.parent).campaign.digest()


def _journal(spec: TuningSpec, trials: Sequence[Trial]) -> bytes:
    """Return the journal of a study; empty without Optuna."""
    if find_spec('optuna') is None:
        return b''
    with tempfile.TemporaryDirectory() as folder:
        TuningStudy(spec, {}, Path(folder)).add(trials)
        return (Path(folder) / JOURNAL).read_bytes()


def _trials(file: Path) -> object:
    if find_spec('optuna') is None:
        return None
    return [
        (each.values, each.state, each.reason, each.further) for each in read_trials(file.parent)
    ]


def _runs(file: Path) -> object:
    return {number: rows.to_pylist() for number, rows in rows_by_trial(file).items()}
