# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of a tuning."""

from base64 import b64encode
from collections.abc import Mapping
from itertools import combinations
from typing import TYPE_CHECKING

from markupsafe import Markup

from ddct_bringup.benchmark.report.texts import figure_name
from ddct_bringup.campaign_report.texts import p_text
from ddct_bringup.report.page_parts import MARKER, number_text, page_part, page_template
from ddct_bringup.tuning.report import texts
from ddct_bringup.tuning.report.commands import PageCommands
from ddct_bringup.tuning.report.figures import (
    front_figure,
    progress_figure,
    slices_figure,
)
from ddct_bringup.tuning.result import TuningResult
from ddct_controllers.design.drawing.chart_style import chart_bytes, chart_style
from ddct_plant.program.command_line import package_version

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from optuna import Study

_ROOM, _REPORT = 'ddct_bringup.tuning.report', 'ddct_bringup.report'
_CAMPAIGN = 'ddct_bringup.campaign_report'


def tuning_page(
    result: TuningResult,
    study: 'Study',
    facts: Mapping[str, str],
    commands: PageCommands,
) -> str:
    """Return the HTML page of a tuning; `facts` describe its origin."""
    with chart_style():
        fronts = [
            (
                f'{goals[0].title} and {goals[1].title}',
                _picture(front_figure(result, study, *at)),
            )
            for at in combinations(range(len(result.objectives)), 2)
            for goals in [[result.objectives[place] for place in at]]
        ]
        objectives = list(enumerate(result.objectives))
        progress = _picture(progress_figure(result, study))
        slices = {e.name: _picture(slices_figure(study, e, place)) for place, e in objectives}
    return page_template(_ROOM, 'tuning.html.j2').render(
        marker=Markup(MARKER),
        style=page_part(_REPORT, 'page.css')
        + page_part(_CAMPAIGN, 'campaign.css')
        + page_part(_ROOM, 'tuning.css'),
        script=page_part(_REPORT, 'common.js'),
        result=result,
        fronts=fronts,
        progress=progress,
        slices=slices,
        notes=list(texts.notes_of(result)),
        texts=texts,
        figure_name=figure_name,
        p_text=p_text,
        number_text=number_text,
        facts=facts,
        commands=commands,
        version=package_version(),
    )


def _picture(figure: 'Figure') -> str:
    """Return a figure as SVG, encoded for a data URI, and close it."""
    from matplotlib import pyplot

    picture = b64encode(chart_bytes(figure, 'svg')).decode()
    pyplot.close(figure)
    return picture
