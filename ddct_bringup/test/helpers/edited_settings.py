# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Custom data of a bag with other settings."""

import json

from ddct_plant.scenario.recorded_settings import SETTINGS


def edited(custom_data, **changes):
    """Return custom data with other settings; what is in no part is of the known scenario."""
    data = json.loads(custom_data[SETTINGS])
    for key, value in changes.items():
        parts = (data, data['known'], data['case'])
        part = next((part for part in parts if key in part), data['known']['scenario'])
        part[key] = value
    return {**custom_data, SETTINGS: json.dumps(data)}
