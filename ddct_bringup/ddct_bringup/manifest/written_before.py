# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Parts of a result that an earlier start has written; the others are computed."""

from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.manifest.file_states import altered_files
from ddct_bringup.manifest.inputs import full_path
from ddct_bringup.manifest.manifest import TUNING, Manifest
from ddct_plant.program.command_line import complain


@dataclass(frozen=True)
class WrittenBefore:
    """
    Files of a result with a manifest.

    Their digests, kept when they were written, say that they are complete: a result is resumed
    with the same plan only.
    """

    result: Path
    manifest: Manifest

    def has(self, file: Path) -> bool:
        """Return whether a file was written before; report one that was altered since."""
        name = full_path(file).relative_to(full_path(self.result)).as_posix()
        if name not in self.manifest.files or not file.exists():
            return False
        if altered_files(self.result, self.manifest, [name]):
            kind = self.manifest.kind
            complain(
                f'ddct {"tune" if kind == TUNING else kind}',
                f'{file}: altered since it was computed: it is computed again',
            )
            return False
        return True
