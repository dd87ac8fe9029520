# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rules for values of a scenario: which belong together, which no car has, which can be run."""
