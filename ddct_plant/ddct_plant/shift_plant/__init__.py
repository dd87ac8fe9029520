# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The plant of a shift by its settings: engine, load, actuators, clutches and driveline."""
