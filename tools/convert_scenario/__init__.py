# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A scenario file of before, with all keys in one, as a car, a drive and a scenario."""
