# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Checks of an exported predictive controller with options and limits, beside its original."""

from pathlib import Path

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.settings import RunSettings
from support.exported_loops import CONTROL_STARTS, compare_loops, pairs
from support.exported_mpc import exported, limited_settings, run_settings


def compare_exported(name: str, settings: RunSettings, folder: Path) -> Trajectory:
    """Export a controller into a folder and compare both loops; return the original's run."""
    original = make_controller(name, settings.known)
    return compare_loops(original, exported(original, name, settings, folder), settings)


def require_exported_options(name: str, folder: Path, *options: str) -> None:
    """Require the same torques under options of a controller, and others than without them."""
    settings = run_settings(*(f'controllers.{name}.{option}' for option in options))
    run = compare_exported(name, settings, folder)
    other = run_headless(run_settings(), name)
    assert np.abs(run.torque_request - other.torque_request).max() > 0.5


def require_exported_authority(folder: Path, changes: tuple[str, ...]) -> None:
    """Require the same torques under changes of the engine's authority, and other engine ones."""
    run = compare_exported('mpc4', run_settings(*changes), folder)
    free = run_headless(run_settings(), 'mpc4')
    assert np.abs(run.engine_torque - free.engine_torque).max() > 1.0


def require_binding_limits(name: str, folder: Path) -> None:
    """Require the same torques under limits of torque and rate that bind."""
    free = run_headless(run_settings(), name).torque_request[CONTROL_STARTS:]
    highest = float(np.quantile(free, 0.8))
    rate = 0.5 * 100.0 * float(np.abs(np.diff(free)).max())
    section = f'controllers.{name}'
    settings = run_settings(
        f'{section}.highest_torque_n_m={highest}', f'{section}.torque_rate_n_m_s={rate}'
    )
    request = compare_exported(name, settings, folder).torque_request[CONTROL_STARTS:]
    at_highest = np.isclose(request, highest, atol=1e-6)
    at_rate = np.isclose(np.abs(np.diff(request)), rate / 100.0, atol=1e-6)
    assert at_highest.any()
    assert at_rate.any()


def require_levels_that_give_way(name: str, folder: Path) -> None:
    """
    Require the same torques where a level gives way to the rate.

    The open loop starts above the highest torque, farther than the rate returns at once.
    """
    run = compare_exported(name, limited_settings(name, 240, 100), folder)
    request = run.torque_request[CONTROL_STARTS - 1 :]
    assert request[0] > 270.0
    assert request[-1] <= 240.0 + 1e-6
    assert np.abs(np.diff(request)).max() <= 1.0 + 1e-6
    assert set(pairs(run, 'qp_status')) == {None, 'solved'}
