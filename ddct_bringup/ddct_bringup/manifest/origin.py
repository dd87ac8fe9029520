# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Origin of computed rows: the version, the commit and the digest of the code that made them."""

from dataclasses import dataclass

from ddct_bringup.manifest.code import code_digest
from ddct_bringup.run.description import short_commit, source_commit
from ddct_plant.program.command_line import package_version


@dataclass(frozen=True)
class CodeOrigin:
    """Code that computed some rows."""

    version: str
    """Version of the packages."""
    commit: str
    """Commit of the sources, as in `run_info`; it may be the same for other code."""
    code: str
    """SHA-256 of the sources: rows of the same digest were computed alike."""

    @classmethod
    def here(cls) -> 'CodeOrigin':
        """Return the origin of rows that this process computes."""
        return cls(package_version(), source_commit(), code_digest())

    @property
    def short(self) -> str:
        """Commit and digest, each shortened."""
        return f'{short_commit(self.commit)} ({self.code[:10]})'

    @property
    def text(self) -> str:
        """Version, commit and digest as text."""
        return f'version {self.version}, commit {self.short}'
