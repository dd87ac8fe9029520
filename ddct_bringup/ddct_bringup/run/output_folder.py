"""Output folders: never half a result, never somebody else's files overwritten."""

import shutil
import tempfile
from pathlib import Path

from ddct_plant.base.errors import DdctError

MARKER = '.ddct-output'
"""Marks a folder as written by these programs, so that `--overwrite` may replace it."""
PARTIAL = '.partial'
"""Ends the name of a folder that is not complete yet."""
_MARKER_TEXT = 'Written by ddct_bringup; --overwrite may replace this folder.\n'


class StagedFolder:
    """
    A folder that appears under its final name only when it is complete.

    Work goes to `<final>.partial` beside it. `commit` puts it in place of an earlier result, which
    stays untouched until then; after a failure the partial folder is left for inspection.
    Whoever uses it holds the final folder (`folder_lock.held`).
    """

    def __init__(self, final: Path, *, overwrite: bool) -> None:
        """Create the partial folder; raise DdctError where something is in the way."""
        self.final = final
        self.path = final.with_name(f'{final.name}{PARTIAL}')
        self._overwrite = overwrite
        self._require_free(final, 'choose another --out or add --overwrite')
        require_ours_or_empty(self.path)
        if not overwrite and any(self.path.rglob('*.mcap')):
            raise DdctError(
                f'{self.path} holds what an interrupted run left: rescue it with '
                '`ddct score --repair`, then remove it or add --overwrite'
            )
        try:
            if self.path.exists():
                shutil.rmtree(self.path)
        except OSError as error:
            raise DdctError(f'{self.path}: cannot be written ({error.strerror})') from error
        mark_folder(self.path)

    def commit(self) -> None:
        """Move the partial folder to its final name; raise DdctError when that fails."""
        self._require_free(self.final, 'it came while this run took place')
        try:
            aside = Path(tempfile.mkdtemp(prefix=f'.{self.final.name}-', dir=self.final.parent))
            replaced = aside / self.final.name
            if self.final.exists():
                self.final.rename(replaced)
            try:
                self.path.rename(self.final)
            except OSError:
                if replaced.exists():
                    replaced.rename(self.final)
                aside.rmdir()
                raise
            shutil.rmtree(aside)
        except OSError as error:
            raise DdctError(f'{self.final}: cannot be replaced ({error.strerror})') from error

    def _require_free(self, folder: Path, advice: str) -> None:
        require_ours_or_empty(folder)
        if not is_empty(folder) and not self._overwrite:
            raise DdctError(f'{folder} already holds a result: {advice}')


def require_ours_or_empty(folder: Path) -> None:
    """Raise DdctError when `folder` holds anything that these programs did not write."""
    if folder.is_symlink():
        raise DdctError(f'{folder} is a symbolic link: give the folder itself, or another --out')
    if folder.exists() and not folder.is_dir():
        raise DdctError(f'{folder} is not a folder: choose another --out')
    if not is_empty(folder) and not (folder / MARKER).is_file():
        raise DdctError(
            f'{folder} holds files that are not ours (no {MARKER} in it): choose another --out'
        )


def is_empty(folder: Path) -> bool:
    """Say whether the folder is absent or has nothing in it."""
    try:
        return not folder.exists() or not any(folder.iterdir())
    except OSError as error:
        raise DdctError(f'{folder}: cannot be read ({error.strerror})') from error


def mark_folder(folder: Path) -> None:
    """Create `folder` as ours when it is absent or empty; raise DdctError otherwise."""
    require_ours_or_empty(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / MARKER).write_text(_MARKER_TEXT, encoding='utf-8')
    except OSError as error:
        raise DdctError(f'{folder}: cannot be written ({error.strerror})') from error
