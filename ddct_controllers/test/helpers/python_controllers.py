# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Text of a controller in Python, for tests that write it into a file."""

IMPORTS = """
from ddct_controllers.interface import Command, Controller
from ddct_plant.base.options import Option
"""
PROPORTIONAL = """
class Mine(Controller):
    options = {'gain': Option(0.1, 'torque per slip error', 'N m/rpm', at_least=0.0)}

    def __init__(self, context):
        self.gain = context.gains['gain']

    def reset(self):
        pass

    def update(self, measurement):
        return Command(-self.gain * measurement.slip_error_rpm)
"""
