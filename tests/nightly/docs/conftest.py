# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The fixtures of the documented commands."""

from support.documented_runs import furnished, install, run_once, shared_runs, workplace

__all__ = ['furnished', 'install', 'run_once', 'shared_runs', 'workplace']
