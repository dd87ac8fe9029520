# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Inputs of a verification: the folder with its digests, limits, files and workers."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ddct_bringup.digests.digest_file import Digests
from ddct_bringup.digests.environment import this_environment
from ddct_bringup.verdict.limits import Limits


@dataclass(frozen=True)
class VerificationRequest:
    """Folder to verify, and the inputs for the repetition of its runs."""

    folder: Path
    digests: Digests
    limits: Limits
    """Limits by which the scores are judged."""
    files: Path | None = None
    """Folder with the controller, handover and scenario files of the result, if moved."""
    workers: int | None = None
    """Number of processes for a campaign; None for one per core."""

    @cached_property
    def environment_differences(self) -> list[str]:
        """Differences between the environment of the result and that of this process, as text."""
        return self.digests.environment.differences(this_environment())

    @property
    def same_environment(self) -> bool:
        """Whether code, versions and kind of processor are those of the result."""
        return not self.environment_differences

    @property
    def same_code(self) -> bool:
        """Whether the sources are those of the result."""
        return self.digests.environment.code == this_environment().code
