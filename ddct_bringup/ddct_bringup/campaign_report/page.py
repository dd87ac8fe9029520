"""The page of a campaign: `report.html`, one file that needs nothing else."""

from collections.abc import Mapping
from typing import Any

import matplotlib as mpl
from markupsafe import Markup

from ddct_bringup.campaign_report import words
from ddct_bringup.campaign_report.maps import FAILED_SHARE, campaign_maps
from ddct_bringup.campaign_report.quantities import quantities_in
from ddct_bringup.campaign_report.results import Results
from ddct_bringup.campaign_report.summary import Summary
from ddct_bringup.report.output import MARKER
from ddct_bringup.report.page_parts import json_data, page_part, page_template
from ddct_bringup.report.tables.verdict_table import value_text
from ddct_bringup.report.typeset import number_text
from ddct_bringup.verdict.metric_figures import TABLE_5_1
from ddct_plant.program.command_line import package_version

_ROOM, _REPORT = 'ddct_bringup.campaign_report', 'ddct_bringup.report'
_RAMP = tuple(mpl.colors.to_hex(mpl.colormaps['cividis'](place / 15)) for place in range(16))
"""Dark to light, made for colour-blind eyes (Nunez, Anderton and Renslow 2018)."""
_SHOWN_FIRST = (FAILED_SHARE, 'peak_jerk_m_s3')
"""The quantity of the maps when the page opens: the first of these that there is."""


def campaign_page(
    results: Results, summary: Summary, folder: str, facts: Mapping[str, str]
) -> str:
    """Return the HTML over a campaign in a folder; `facts` are words about where it is from."""
    quantities = quantities_in(results.columns)
    maps = campaign_maps(results, quantities)
    replay = words.replay_command(folder, 'INDEX')
    return page_template(_ROOM, 'campaign.html.j2').render(
        marker=Markup(MARKER),
        style=page_part(_REPORT, 'page.css') + page_part(_ROOM, 'campaign.css'),
        script=page_part(_REPORT, 'common.js') + page_part(_ROOM, 'campaign.js'),
        data=json_data({'maps': maps, 'ramp': _RAMP, 'replay': replay}),
        maps=maps,
        chosen=_chosen(maps['quantities']) if maps else 0,
        summary=summary,
        labels=[group.label for group in results.groups],
        numbers=results.numbers,
        words=words,
        value_text=value_text,
        number_text=number_text,
        figures={figure.key: figure for figure in quantities},
        first=[figure.key for figure in TABLE_5_1],
        replay=replay,
        folder=folder,
        facts=facts,
        version=package_version(),
    )


def _chosen(quantities: list[dict[str, Any]]) -> int:
    """Return the place of the quantity that the maps show when the page opens."""
    keys = [each['key'] for each in quantities]
    return next((keys.index(key) for key in _SHOWN_FIRST if key in keys), 0)
