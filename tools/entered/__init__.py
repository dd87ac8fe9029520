# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Classes and functions that a run enters, from the program to the equations of the plant."""
