# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plant of the dual dry clutch transmission: engine, load, clutch, driveline, actuator."""

from ddct_plant.program.arithmetic import choose_kernel

choose_kernel()
