# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The controllers of the state of the art by their names in the registry."""

from ddct_controllers.interface import Controller, ControllerSpec
from ddct_controllers.state_of_art import lqi, pedal_mpc, two_speeds

STATE_OF_ART: dict[str, ControllerSpec[Controller]] = {
    spec.name: spec for spec in (*two_speeds.SPECS, pedal_mpc.SPEC, lqi.SPEC)
}
"""Specifications by name: [2], [3] and [4] of the thesis, then LQI."""
