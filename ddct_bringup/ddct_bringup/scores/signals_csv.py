"""The signals of a recording as a CSV file, one row per tick, units in the names."""

import csv
import io

import numpy as np

from ddct_bringup.bag.reader import Recording
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.graph.message_values import JOINTS


def signals_csv(recording: Recording) -> str:
    """Return the text; of previews and torques within the period the value at the tick."""
    columns = _columns(recording.trajectory)
    if recording.trajectory.engine_torque_request is not None:
        columns['engine_torque_request_n_m'] = recording.trajectory.engine_torque_request
    text = io.StringIO()
    writer = csv.writer(text, lineterminator='\n')
    writer.writerow(columns)
    # Python's floats print with the digits that give them back to the last bit.
    writer.writerows(zip(*(column.tolist() for column in columns.values()), strict=True))
    return text.getvalue()


def _columns(trajectory: Trajectory) -> dict[str, np.ndarray]:
    columns = {'time_s': trajectory.time_s}
    for index, joint in enumerate(JOINTS):
        columns[f'{joint}_position_rad'] = trajectory.joint_position[:, index]
        columns[f'{joint}_speed_rad_s'] = trajectory.joint_speed[:, index]
        columns[f'{joint}_effort_n_m'] = trajectory.joint_effort[:, index]
    return {
        **columns,
        'slip_speed_rad_s': trajectory.slip_speed,
        'slip_reference_rad_s': trajectory.slip_reference[:, 0],
        'slip_reference_rate_rad_s2': trajectory.slip_reference_rate[:, 0],
        'vehicle_speed_m_s': trajectory.vehicle_speed,
        'vehicle_accel_m_s2': trajectory.vehicle_accel,
        'torque_demand_n_m': trajectory.torque_demand,
        'engine_torque_n_m': trajectory.engine_torque,
        'load_torque_n_m': trajectory.load_torque,
        'torque_request_n_m': trajectory.torque_request,
        'actuator_torque_n_m': trajectory.actuator_torque[:, 0],
        'clutch_torque_n_m': trajectory.clutch_torque[:, 0],
    }
