# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Sensor models: gain, constant offset, noise, quantisation, delay and dropout."""
