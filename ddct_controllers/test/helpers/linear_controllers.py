# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names of the controllers with a linear model, without making all of them."""

from ddct_controllers.registry import controller_names

NOT_LINEAR = (
    *('mpc1', 'mpc2', 'mpc3', 'mpc4', 'mpc_preview', 'mpc_offset_free', 'mpc_torsion', 'mpc_wear'),
    *('mpc4_wear', 'torque_estimator', 'decoupled_pid', 'pedal_mpc', 'least_jerk'),
)
LINEAR = [name for name in controller_names() if name not in NOT_LINEAR]
"""`test_linear_model.py` tests that these are the ones."""
