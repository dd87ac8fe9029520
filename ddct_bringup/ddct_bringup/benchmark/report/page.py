# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of a benchmark."""

import shlex

from markupsafe import Markup

from ddct_bringup.benchmark.report import rules, texts
from ddct_bringup.benchmark.result_types import Result
from ddct_bringup.benchmark.update_times import UpdateTimesFile
from ddct_bringup.campaign_report import texts as campaign_texts
from ddct_bringup.documents.page_parts import (
    DOCUMENTS,
    MARKER,
    number_text,
    page_part,
    page_template,
    value_text,
)
from ddct_bringup.evaluation.quantities import MAIN, QUANTITIES
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.program.command_line import package_version

_ROOM = 'ddct_bringup.benchmark.report'
_CAMPAIGN = 'ddct_bringup.campaign_report'


def benchmark_page(result: Result, update_times: UpdateTimesFile) -> str:
    """
    Return the HTML page of a benchmark, whose commands are for the folder that it is in.

    Only the cells of the class `wall` depend on the wall clock.
    """
    return page_template(_ROOM, 'benchmark.html.j2').render(
        marker=Markup(MARKER),
        style=page_part(DOCUMENTS, 'page.css')
        + page_part(_CAMPAIGN, 'campaign.css')
        + page_part(_ROOM, 'benchmark.css'),
        script=page_part(DOCUMENTS, 'page.js') + page_part(_ROOM, 'benchmark.js'),
        result=result,
        update_times=update_times.controllers,
        notes=list(texts.notes_of(result)),
        warnings=list(texts.warnings_of(result)),
        texts=texts,
        shell_line=_shell_line,
        campaign_texts=campaign_texts,
        quantities=QUANTITIES,
        main=list(MAIN),
        further=_further(result),
        states=rules.states_that_count(packaged_limits().rules),
        figures=rules.figures_that_count(),
        no_gain=rules.NO_GAIN,
        left_open=rules.left_open_here(),
        number_text=number_text,
        value_text=value_text,
        version=package_version(),
    )


def _shell_line(*words: object) -> str:
    """Return a command as a line for a shell."""
    return shlex.join(map(str, words))


def _further(result: Result) -> list[str]:
    """Return the quantities besides the figures that a run of a judged controller has."""
    there = {
        key
        for judged in result.judged
        for summary in (result.development, judged.held_out)
        if summary
        for key, found in summary.group(judged.controller).quantities.items()
        if found.with_value
    }
    return [key for key in QUANTITIES if key in there and key not in MAIN]
