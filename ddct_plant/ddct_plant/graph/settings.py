"""The ROS parameters that every node declares, as validated `RunSettings`."""

from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node

from ddct_plant.base.errors import ParameterError
from ddct_plant.fail_safe.request_watch import (
    LEAST_REQUEST_TIMEOUT_S,
    MOST_REQUEST_TIMEOUT_S,
    REQUEST_TIMEOUT_S,
    FailSafeSettings,
)
from ddct_plant.models.clutch import CLUTCHES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import ARCHITECTURES, MODES, RunSettings


def declare_settings(node: Node) -> RunSettings:
    """Declare the shared parameters on `node`; raise ParameterError for a value out of range."""
    scenario = declare(
        node, 'scenario', 'thesis', 'Name of a packaged scenario, or path of a YAML file'
    )
    return RunSettings(
        scenario=load_scenario(scenario),
        architecture=declare(
            node, 'architecture', 'detailed', f'One of: {", ".join(ARCHITECTURES)}'
        ),
        clutch=declare(node, 'clutch', 'linear', f'One of: {", ".join(CLUTCHES)}'),
        wear_gain=declare(node, 'wear_gain', 1.0, 'K_usura, clutch wear gain [-]', 0.0, 3.0),
        mode=declare(node, 'mode', 'lockstep', f'One of: {", ".join(MODES)}'),
        seed=declare(node, 'seed', 0, 'Seed of random numbers', 0, 2**31 - 1),
    )


def declare_request_timeout(node: Node, afterwards: str) -> float:
    """Declare how long requests may stop in real time, and what happens `afterwards`; in s."""
    description = f'Real time: when requests stop for longer [s], {afterwards}'
    return declare_timeout(node, 'request_timeout_s', REQUEST_TIMEOUT_S, description)


def declare_timeout(node: Node, name: str, default: float, description: str) -> float:
    """Declare how long something may stay away in real time, in s."""
    return declare(
        node, name, default, description, LEAST_REQUEST_TIMEOUT_S, MOST_REQUEST_TIMEOUT_S
    )


def declare_fail_safe_ramp(node: Node) -> float:
    """Declare how fast the clutch then opens, in N m/s."""
    return declare(
        node,
        'fail_safe_ramp_n_m_s',
        FailSafeSettings.fail_safe_ramp_n_m_s,
        'Real time: rate at which the clutch opens in the safe state [N m/s]',
    )


def declare(
    node: Node,
    name: str,
    default: Any,
    description: str,
    at_least: float | None = None,
    at_most: float | None = None,
    *,
    read_only: bool = True,
) -> Any:
    """Declare one parameter with its description and range, and return its value."""
    descriptor = ParameterDescriptor(description=description, read_only=read_only)
    if at_least is not None and at_most is not None:
        if isinstance(default, float):
            descriptor.floating_point_range = [
                FloatingPointRange(from_value=float(at_least), to_value=float(at_most), step=0.0)
            ]
        else:
            descriptor.integer_range = [
                IntegerRange(from_value=int(at_least), to_value=int(at_most), step=1)
            ]
    try:
        return node.declare_parameter(name, default, descriptor).value
    except (InvalidParameterTypeException, InvalidParameterValueException) as error:
        raise ParameterError(f'parameter {name}: {error} ({description})') from error
