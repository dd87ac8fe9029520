"""The controllers of the state of the art by their names in the registry."""

from collections.abc import Callable

from ddct_controllers.interface import Controller, ControllerContext
from ddct_controllers.state_of_art import decoupled_pid, lqi, pedal_mpc, torque_estimator

STATE_OF_ART: dict[str, Callable[[ControllerContext], Controller]] = {
    torque_estimator.NAME: torque_estimator.TorqueEstimatorControl,
    decoupled_pid.NAME: decoupled_pid.DecoupledPid,
    pedal_mpc.NAME: pedal_mpc.PedalMpc,
    lqi.NAME: lqi.make_lqi,
}
"""Factories: [2], [3] and [4] of the thesis, then LQI."""
