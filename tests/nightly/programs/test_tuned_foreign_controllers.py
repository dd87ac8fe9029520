# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The parameters of an FMU and of a library in C are tuned as the gains of the PI in Python."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from small_tuning import CONTENT, made_tuning
from support.exported_mpc import compile_c, run_settings
from support.fmu import controller_file, skip_without_fmus

from ddct_bringup.campaign.arrow_columns import read_parquet
from ddct_bringup.run.headless import run_headless
from ddct_bringup.tuning.tables import TRIALS
from ddct_controllers.from_file.c_library.library import HEADER, TEMPLATE
from ddct_controllers.registry import controller_spec

pytest.importorskip('optuna', reason='Optuna, an optional extra, is absent: EXTRAS=tune')
pytestmark = [pytest.mark.slow, pytest.mark.compiler]

RANGES = CONTENT['parameters']
FEW = {
    'trials': 3,
    'campaign': {'scenario': 'thesis', 'random': {**CONTENT['campaign']['random'], 'samples': 2}},
}


def fmu() -> tuple[str, list[str]]:
    """Return a controller file with an FMU, and its names of both gains."""
    skip_without_fmus()
    return controller_file(2), ['pid_Kp', 'pid_Ki']


def library() -> tuple[str, list[str]]:
    """Return a controller file with a library in C, and its names of both gains."""
    for name in (HEADER, 'my_controller.c'):
        Path(name).write_bytes((TEMPLATE / name).read_bytes())
    compile_c(Path.cwd(), '-shared', '-fPIC', 'my_controller.c', '-o', 'my_controller.so')
    gains = '{proportional_gain: 0.2, integral_gain: 0.3}'
    Path('in_c.yaml').write_text(
        f'name: in_c\nc_library: {{file: my_controller.so, parameters: {gains}}}\n',
        encoding='utf-8',
    )
    return 'in_c.yaml', list(RANGES)


@pytest.mark.parametrize('written', [fmu, library])
def test_a_foreign_controller_is_tuned_as_ours(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, written: Callable[[], tuple[str, list[str]]]
) -> None:
    monkeypatch.chdir(tmp_path)
    file, names = written()
    ranges = dict(zip(names, RANGES.values(), strict=True))
    theirs = made_tuning(Path('theirs'), controller=file, parameters=ranges, **FEW)
    ours = made_tuning(Path('ours'), **FEW)
    compared = 0
    # The first trial has the values of each file, the others those of the search.
    for our, their in list(zip(trials(ours), trials(theirs), strict=True))[1:]:
        assert [our[name] for name in RANGES] == [their[name] for name in names]
        assert our['state'] == their['state']
        if our['state'] == 'feasible':
            for name in CONTENT['objectives']:
                assert their[name] == pytest.approx(our[name], rel=1e-6)
            compared += 1
    assert compared
    best = str(theirs / 'best.yaml')
    assert set(controller_spec(best).options or ()) >= set(names)
    assert run_headless(run_settings('duration_s=1'), best).torque_request[-1] > 0.0


def trials(folder: Path) -> list[dict[str, Any]]:
    """Return the trials of a folder of a tuning."""
    found: list[dict[str, Any]] = read_parquet(folder / TRIALS).to_pylist()
    return found
