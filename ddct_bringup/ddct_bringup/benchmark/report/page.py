# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of a benchmark."""

import shlex
from pathlib import Path

from markupsafe import Markup

from ddct_bringup.benchmark.report import texts
from ddct_bringup.benchmark.result_types import (
    Evaluation,
    QuantityResult,
    Result,
    ScenarioResult,
)
from ddct_bringup.benchmark.update_times import UpdateTimesFile
from ddct_bringup.campaign_report import texts as campaign_texts
from ddct_bringup.campaign_report.evaluated_quantities import QUANTITIES
from ddct_bringup.campaign_report.printed_summary import MAIN
from ddct_bringup.report.page_parts import (
    MARKER,
    number_text,
    page_part,
    page_template,
    value_text,
)
from ddct_plant.program.command_line import package_version

_ROOM, _REPORT = 'ddct_bringup.benchmark.report', 'ddct_bringup.report'
_CAMPAIGN = 'ddct_bringup.campaign_report'
RATIO_FORM = '.2f'
"""Format of a ratio to the least."""


def benchmark_page(result: Result, update_times: UpdateTimesFile, folder: Path) -> str:
    """
    Return the HTML page of a benchmark in a folder, which its commands name.

    Besides those, only the cells of the class `wall` depend on the wall clock.
    """
    return page_template(_ROOM, 'benchmark.html.j2').render(
        marker=Markup(MARKER),
        style=page_part(_REPORT, 'page.css')
        + page_part(_CAMPAIGN, 'campaign.css')
        + page_part(_ROOM, 'benchmark.css'),
        script=page_part(_REPORT, 'common.js') + page_part(_ROOM, 'benchmark.js'),
        result=result,
        update_times=update_times['controllers'],
        notes=list(texts.notes_of(result)),
        warnings=list(texts.warnings_of(result)),
        texts=texts,
        folder=folder,
        shell_line=_shell_line,
        campaign_texts=campaign_texts,
        quantities={quantity.key: quantity for quantity in QUANTITIES},
        main=list(MAIN),
        further=_further(result),
        ratio=RATIO_FORM,
        spread=_spread,
        number_text=number_text,
        value_text=value_text,
        version=package_version(),
    )


def _shell_line(*words: object) -> str:
    """Return a command as a line for a shell."""
    return shlex.join(map(str, words))


def _further(result: Result) -> list[str]:
    """Return the quantities besides the main ones that a run of a judged controller has."""
    there = {
        quantity['name']
        for judged in result['controllers']
        for evaluation in (*(judged['development'] or ()), *(judged['held_out'] or ()))
        for quantity in evaluation['quantities']
        if quantity['with_value']
    }
    return [each.key for each in QUANTITIES if each.key in there and each.key not in MAIN]


def _spread(evaluation: Evaluation | ScenarioResult, name: str) -> QuantityResult | None:
    """Return the distribution of one quantity, None where no run has it."""
    return next((each for each in evaluation['quantities'] if each['name'] == name), None)
