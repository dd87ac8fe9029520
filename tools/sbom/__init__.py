# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What is installed, and what the wheels bundle."""
