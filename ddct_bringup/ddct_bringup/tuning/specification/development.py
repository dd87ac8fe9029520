# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Development cases of a tuning, in their parts, and the specification of the held-out ones.

Every trial has the same cases. A part contains whole samples: the first ones at all points of the
grid, so that every scenario is in the first part.
"""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.keys import CONTROLLERS, FILE_KEY, SCENARIO
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.campaign.specification.named_files import with_places
from ddct_bringup.campaign.specification.parts import (
    GRID,
    OF,
    RANDOM,
    ROOT_SEED,
    SAMPLES,
    mapping_of,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import require_known
from ddct_plant.files.input_file import located
from ddct_plant.scenario.choices.scenarios import is_packaged
from ddct_plant.scenario.nouns.keys import CAR

CAMPAIGN, BENCHMARK = 'campaign', 'benchmark'
_SHARES = (0.25, 0.5, 1.0)
"""Shares of the cases after which a trial may be ended: successive halving."""


@dataclass(frozen=True)
class Development:
    """Specification of the cases, and which of them run in development."""

    content: Mapping[str, Any]
    """Specification of a campaign without controllers."""
    scenarios: tuple[str, ...] = ()
    """Those scenarios of a benchmark that run; empty for all cases."""
    samples: int | None = None
    """Number of samples of a benchmark that run at each point, None for all."""

    @classmethod
    def of(cls, content: Any, folder: Path) -> 'Development':
        """
        Return the cases of a specification, whose files are relative to `folder`.

        Raise ParameterError that names the key.
        """
        if isinstance(content, Mapping) and BENCHMARK in content:
            return cls._of_benchmark(content, folder)
        if not isinstance(content, Mapping):
            raise ParameterError(
                f'{CAMPAIGN} is {content!r}: give keys of a campaign, or {{{BENCHMARK}: all}}',
                key=CAMPAIGN,
            )
        if CONTROLLERS in content:
            raise ParameterError(
                f'{CAMPAIGN}.{CONTROLLERS}: leave it out: the tuning decides it',
                key=f'{CAMPAIGN}.{CONTROLLERS}',
            )
        for key in content.get(GRID) or ():
            if str(key).endswith(FILE_KEY):
                raise ParameterError(
                    f'{CAMPAIGN}.{GRID}.{key}: name the file in a scenario, and give that',
                    key=f'{CAMPAIGN}.{GRID}.{key}',
                )
        return cls(dict(content))

    @classmethod
    def _of_benchmark(cls, content: Mapping[str, Any], folder: Path) -> 'Development':
        keys = mapping_of(CAMPAIGN, content, (BENCHMARK, SAMPLES, CAR), f'{CAMPAIGN}.')
        of_car = {}
        if (car := keys.get(CAR)) is not None:
            of_car = {CAR: str(car)}
        packaged = Cases.packaged(car=in_folder(folder, str(car)) if of_car else None)
        cases = {**packaged.content, **of_car}
        cases.pop(CONTROLLERS, None)
        known = cases[GRID][SCENARIO]
        names = keys[BENCHMARK]
        where = f'{CAMPAIGN}.{BENCHMARK}'
        for name in names if isinstance(names, list) else ():
            if name in packaged.left_out:
                raise ParameterError(
                    f'{where}: the car cannot drive {name}: {packaged.left_out[name]}', key=where
                )
        if names == 'all':
            names = known
        if not isinstance(names, list) or not names:
            raise ParameterError(
                f'{where} is {names!r}: give all, or a list of scenarios', key=where
            )
        require_known(names, known, 'scenario of the benchmark', f'{where}.')
        most = cases[RANDOM][SAMPLES]
        samples = keys.get(SAMPLES, most)
        if isinstance(samples, bool) or not isinstance(samples, int) or not 1 <= samples <= most:
            raise ParameterError(
                f'{CAMPAIGN}.{SAMPLES} is {samples!r}: give 1 to {most}',
                key=f'{CAMPAIGN}.{SAMPLES}',
            )
        return cls(cases, tuple(names), samples)

    def moved(self, old: Path, new: Path) -> 'Development':
        """Return the same cases with the files that they name relative to another folder."""
        content = with_places(self.content, lambda _, name: os.path.relpath(old / name, new))
        return replace(self, content=content)

    def campaign(self, controller: str, folder: Path) -> Campaign:
        """Return the campaign that contains the cases; files are relative to `folder`."""
        content = {**self.content, CONTROLLERS: [controller]}
        with located(CAMPAIGN):
            return Campaign(spec_of(content, folder))

    def cases(self, campaign: Campaign) -> list[int]:
        """Return the development cases in the order in which they run: by sample, then point."""
        chosen = list(range(campaign.cases))
        if self.scenarios:
            names = [each[SCENARIO] for each in campaign.varied(range(campaign.cases))]
            chosen = [
                case
                for case in chosen
                if names[case] in self.scenarios
                and case % campaign.samples < (self.samples or campaign.samples)
            ]
        return sorted(chosen, key=lambda case: (case % campaign.samples, case))

    def held_out(self, controllers: Sequence[str], folder: Path, seed: int) -> Campaign:
        """Return the campaign of held-out cases: drawn in the same way, from another seed."""
        content = {**self.content, CONTROLLERS: list(controllers), ROOT_SEED: seed}
        if self.scenarios:
            content[GRID] = {**content[GRID], SCENARIO: list(self.scenarios)}
            random = content[RANDOM]
            content[RANDOM] = {OF: random[SAMPLES], **random, SAMPLES: self.samples}
        return Campaign(spec_of(content, folder))


def in_folder(folder: Path, name: str) -> str:
    """Return a packaged name, or the path of a file that a folder's specification names."""
    return name if is_packaged(name) else str(folder / name)


def parts_of(cases: Sequence[int], least: int = 1) -> list[Sequence[int]]:
    """Return the parts of the cases in order; all but the last have at least `least` cases."""
    ends = [0]
    for share in _SHARES:
        end = max(1, round(share * len(cases)))
        if end == len(cases) or end - ends[-1] >= least:
            ends.append(end)
    pairs = zip(ends, ends[1:], strict=False)
    return [cases[first:last] for first, last in pairs if first < last]
