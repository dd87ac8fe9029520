# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline of a measured car from a log of a drive: fit, verdict, scenario."""
