# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run of our plant as a bus logger records it: frames of a CAN bus in an MDF 4 file."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory

DBC = """\
VERSION ""

BU_: ECM TCM ABS

BO_ 272 ENGINE_1: 8 ECM
 SG_ EngineSpeed : 0|16@1+ (0.25,0) [0|16383] "rpm" TCM
 SG_ EngineTorque : 16|12@1+ (1,-1000) [-1000|3095] "Nm" TCM
 SG_ DriverTorqueReq : 32|12@1+ (1,-1000) [-1000|3095] "Nm" TCM

BO_ 288 TRANSM_1: 8 TCM
 SG_ InputShaftSpeed : 0|16@1+ (0.25,0) [0|16383] "rpm" ECM
 SG_ ClutchTorque : 16|12@1+ (1,-1000) [-1000|3095] "Nm" ECM
 SG_ ClutchTorqueReq : 32|12@1+ (1,-1000) [-1000|3095] "Nm" ECM

BO_ 304 ABS_WHEELS: 8 ABS
 SG_ WheelSpeed_FL : 0|16@1+ (0.01,0) [0|655] "km/h" TCM
 SG_ WheelSpeed_FR : 16|16@1+ (0.01,0) [0|655] "km/h" TCM
 SG_ WheelSpeed_RL : 32|16@1+ (0.01,0) [0|655] "km/h" TCM
 SG_ WheelSpeed_RR : 48|16@1+ (0.01,0) [0|655] "km/h" TCM

BO_ 320 ABS_VEHICLE: 8 ABS
 SG_ VehicleSpeed : 0|16@1+ (0.01,0) [0|655] "km/h" TCM
 SG_ LongAccel : 16|16@1- (0.01,0) [-327|327] "m/s2" TCM
"""
"""
A DBC of the shape of those of production: speeds of .25 rpm and .01 km/h, torques of 1 N m.

Its signals are of our own making.
"""
_OFFSETS_S = {'ENGINE_1': 0.0, 'TRANSM_1': 0.0004, 'ABS_WHEELS': 0.0031, 'ABS_VEHICLE': 0.0046}
"""Delays in s of the frames of a tick on the bus."""


def bus_signals(run: Trajectory, radius_m: float) -> Mapping[str, np.ndarray]:
    """Return the signals of the bus by name, (n,), in the units of the DBC."""
    rpm, km_h = 30.0 / np.pi, 3.6
    wheel = run.wheel_speed * radius_m * km_h
    return {
        'EngineSpeed': run.engine_speed * rpm,
        'EngineTorque': run.engine_torque,
        'DriverTorqueReq': run.torque_demand,
        'InputShaftSpeed': run.primary_shaft_speed * rpm,
        'ClutchTorque': run.primary_shaft_effort,
        'ClutchTorqueReq': run.torque_request,
        **{f'WheelSpeed_{place}': wheel for place in ('FL', 'FR', 'RL', 'RR')},
        'VehicleSpeed': run.vehicle_speed * km_h,
        'LongAccel': run.vehicle_accel,
    }


def write_bus_log(folder: Path, run: Trajectory, radius_m: float) -> tuple[Path, Path]:
    """Write a run as `drive.mf4` with frames of a CAN bus, and its `car.dbc`; return both."""
    import canmatrix.formats
    from asammdf import MDF, Signal, Source

    (folder / 'car.dbc').write_text(DBC)
    matrix = canmatrix.formats.loadp_flat(str(folder / 'car.dbc'))
    signals = bus_signals(run, radius_m)
    frames = []
    for frame in matrix.frames:
        for step in range(run.steps + 1):
            values = {
                each.name: each.phys2raw(float(signals[each.name][step])) for each in frame.signals
            }
            time_s = 0.01 * step + _OFFSETS_S[frame.name]
            frames.append((time_s, frame.arbitration_id.id, frame.encode(values)))
    frames.sort()
    rows = np.zeros(len(frames), _FRAME)
    rows['CAN_DataFrame.BusChannel'] = 1
    rows['CAN_DataFrame.ID'] = [each for _, each, _ in frames]
    rows['CAN_DataFrame.DLC'] = rows['CAN_DataFrame.DataLength'] = 8
    rows['CAN_DataFrame.DataBytes'] = [list(data) for *_, data in frames]
    bus = Source('CAN', 'CAN', 'frames of the bus', Source.SOURCE_BUS, Source.BUS_TYPE_CAN)
    times = np.array([time_s for time_s, *_ in frames])
    with MDF(version='4.10') as file:
        file.append(
            Signal(rows, times, name='CAN_DataFrame', source=bus), comment='CAN', acq_source=bus
        )
        file.save(folder / 'drive.mf4', overwrite=True)
    return folder / 'drive.mf4', folder / 'car.dbc'


_FRAME = np.dtype(
    [
        ('CAN_DataFrame.BusChannel', 'u1'),
        ('CAN_DataFrame.ID', '<u4'),
        ('CAN_DataFrame.IDE', 'u1'),
        ('CAN_DataFrame.DLC', 'u1'),
        ('CAN_DataFrame.DataLength', 'u1'),
        ('CAN_DataFrame.DataBytes', 'u1', (8,)),
    ]
)
"""Fields of a CAN frame by ASAM MDF's bus logging."""
