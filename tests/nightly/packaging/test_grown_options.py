# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A sensor that is added as CONTRIBUTING shows it has options, and works in headless runs."""

from pathlib import Path

from support.grown import SETTINGS, apply, output_of


def test_a_sensor_has_options_and_is_in_headless_runs(tmp_path: Path) -> None:
    code = f"""{SETTINGS}
import pickle
from ddct_plant.base.options import options_of
from ddct_plant.sensors.parameters import VehicleAccelSensor

print(*options_of(VehicleAccelSensor))
assert pickle.loads(pickle.dumps(scenario)) == scenario
received = run.sensed_vehicle_accel_held == 0.0
assert 30 < np.count_nonzero(received) < 80
assert np.array_equal(
    run.sensed_vehicle_accel[received], run.vehicle_accel[received] + 0.5
)
print(run.sensed)
"""
    (options, sensed) = output_of(code, tmp_path, apply('A sensor', tmp_path))
    assert options.split() == [
        *('gain', 'delay_s', 'dropout', 'dropout_burst'),
        *('noise_m_s2', 'quantum_m_s2', 'bias_m_s2'),
    ]
    assert sensed == 'True'
