# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A judged controller, and the seed of its held-out cases, which nobody can choose."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.manifest.code import code_digest, package_digest
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.plugins import CONTROLLERS
from ddct_controllers.registry import (
    controller_spec,
    own_controller_names,
)
from ddct_plant.base.errors import ParameterError, require_name

_SEEDS = 2**31
"""Number of seeds that a campaign can have."""


@dataclass(frozen=True)
class Judged:
    """A controller that is judged."""

    name: str
    """Name in results."""
    chosen: str
    """Name, or name of the controller file without its folder."""
    folder: Path
    """Folder of the controller file; the current one for a controller without a file."""
    digests: Mapping[str, str]
    """SHA-256 of the files that it is made of, or of the package that has it, by their key."""

    def __post_init__(self) -> None:
        """Raise ParameterError for names with a folder, as in an altered manifest."""
        require_no_path(self.name, self.chosen)

    @classmethod
    def of(cls, chosen: str) -> 'Judged':
        """Return a controller by name or file; raise DdctError where it cannot be loaded."""
        spec = controller_spec(chosen)
        if is_controller_file(chosen):
            path = Path(chosen).absolute()
            return cls(spec.name, path.name, path.parent, dict(spec.digests))
        return cls(spec.name, chosen, Path.cwd(), _package_digests(chosen))

    @property
    def path(self) -> str:
        """Name, or path of the controller file."""
        is_file = is_controller_file(self.chosen)
        return str(self.folder / self.chosen) if is_file else self.chosen

    @property
    def is_packaged(self) -> bool:
        """Whether it comes with this release, which then has its rows of development cases."""
        return self.chosen in own_controller_names()

    def held_out_seed(self, release: str) -> int:
        """
        Return the seed of its held-out cases in a release with this digest of its code.

        Any other byte of the controller or the release gives another seed. The name counts for
        controllers that share a package.
        """
        content = {'controller': sorted(self.digests.items()), 'release': release}
        if not is_controller_file(self.chosen):
            content['name'] = self.name
        return seed_of(content)


def require_no_path(name: str, chosen: str) -> None:
    """Raise ParameterError unless the name and the file's name are parts of a path, not paths."""
    require_name('controllers.name', name)
    if Path(chosen).name != chosen:
        raise ParameterError(
            f'controllers.chosen is {chosen!r}: it must have no folder', key='controllers.chosen'
        )


def seed_of(content: Mapping[str, object]) -> int:
    """Return the seed of held-out cases that follows from digests, as nested mappings of JSON."""
    digest = hashlib.sha256(json.dumps(content, sort_keys=True).encode()).digest()
    return int.from_bytes(digest[:8], 'little') % _SEEDS


def _package_digests(name: str) -> dict[str, str]:
    """Return the digest of the package that has a controller, by the package's name."""
    if name in own_controller_names():
        return {'ddct': code_digest()}
    if point := CONTROLLERS.point(name):
        package = point.module.partition('.')[0]
        return {package: package_digest(package)}
    return {}
