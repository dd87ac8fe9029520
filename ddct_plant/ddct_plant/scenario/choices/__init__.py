# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What can be chosen for a run, and its options in a program; cheap to import."""
