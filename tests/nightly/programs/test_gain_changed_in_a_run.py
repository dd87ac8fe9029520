# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every program names a gain that was changed by `ros2 param set` while `bringup` ran."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from support.observer import Observing
from support.processes import Programs
from waiting import wait_until

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.programs import report, score, verify

pytestmark = pytest.mark.slow

CHANGED = 'gains changed in the run: proportional_gain 0.103 to 1 at '


def set_in_the_run(observing: Observing, values: dict[str, Any]) -> Sequence[SetParametersResult]:
    """Set parameters of the controller, as `ros2 param set` does, once step 70 is observed."""
    client = observing.observer.create_client(SetParameters, '/controller/set_parameters')
    ticks = observing.observer.joints
    wait_until(lambda: observing.listen() and client.service_is_ready(), 'the service')
    wait_until(lambda: observing.listen() and max(ticks, default=0) > 70, 'step 70')
    given = [Parameter(name, value=value) for name, value in values.items()]
    parameters = [each.to_parameter_msg() for each in given]
    answer = client.call_async(SetParameters.Request(parameters=parameters))
    wait_until(lambda: observing.listen() and answer.done(), 'the answer')
    results: Sequence[SetParametersResult] = answer.result().results
    return results


def test_a_gain_changed_in_a_run_is_named_by_every_program(
    programs: Programs, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'runs'
    values = {'gains.proportional_gain': 1, 'gains.nix': 1.0, 'gains.integral_gain': -1.0}
    with Observing() as observing:
        bringup = programs.start_module(
            'ddct_bringup.programs.bringup', '--duration', '20', '--out', str(out)
        )
        good, unknown, negative = set_in_the_run(observing, values)
        assert bringup.wait() == 0, bringup.errors()
    assert (good.successful, unknown.successful, negative.successful) == (True, False, False)
    assert unknown.reason == (
        'unknown parameter gains.nix: known: gains.proportional_gain, gains.integral_gain'
    )
    assert 'integral_gain is -1' in negative.reason
    (change,) = read_bag(out / 'pi').gain_changes
    assert 70 < change.step < 2000
    line = f'{CHANGED}{change.time_s:g} s'
    assert f'bringup: {line}' in bringup.errors()

    assert score.main([str(out), '--json', str(tmp_path / 'scores.json')]) == 0
    assert f'pi: {line}' in capfd.readouterr().out
    (run,) = json.loads((tmp_path / 'scores.json').read_text(encoding='utf-8'))['runs']
    changed = {'gain': 'proportional_gain', 'before': 0.103, 'after': 1.0}
    assert run['gain_changes'] == [{**changed, 'time_s': change.time_s}]
    assert report.main([str(out), '--out', str(tmp_path / 'page.html')]) == 0
    assert line in (tmp_path / 'page.html').read_text(encoding='utf-8')
    capfd.readouterr()
    assert verify.main([str(out / 'pi')]) == 0
    text = capfd.readouterr().out
    assert 'same bits' in text and line in text
