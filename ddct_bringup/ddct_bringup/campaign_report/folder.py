# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write the summary and the page of a campaign into its folder."""

from base64 import b64encode
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

from markupsafe import Markup

from ddct_bringup.campaign.keys import COMMON, SCENARIO
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign_report import texts
from ddct_bringup.campaign_report.distributions_chart import distributions_chart
from ddct_bringup.campaign_report.map_types import MapScale
from ddct_bringup.campaign_report.maps import FAILED_SHARE, campaign_maps
from ddct_bringup.campaign_report.printed_summary import MAIN
from ddct_bringup.campaign_report.reading import grouped_rows, read_table
from ddct_bringup.documents.chart_files import matplotlib_figure
from ddct_bringup.documents.page_parts import (
    DOCUMENTS,
    MARKER,
    json_data,
    number_text,
    page_part,
    page_template,
    value_text,
)
from ddct_bringup.evaluation.grouped_rows import GroupedRows
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.evaluation.summary import Summary, SummaryFile
from ddct_bringup.manifest.manifest import MANIFEST, finish_manifest, keep_digests
from ddct_bringup.metrics.catalogue import TABLE_5_1
from ddct_bringup.run.output_folder import locked_folders
from ddct_controllers.design.drawing.chart_style import chart_bytes, chart_style
from ddct_plant.files.json_records import to_json, write_json
from ddct_plant.files.output_file import write_text
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.program.command_line import package_version
from ddct_plant.scenario.choices.scenarios import CHOICES, DEFAULT_SCENARIO

SUMMARY, PAGE = 'summary.json', 'report.html'
_ROOM = 'ddct_bringup.campaign_report'
_SHOWN_FIRST = (FAILED_SHARE, 'peak_jerk_m_s3')
"""Quantities that the maps show when the page opens, the first available one of these."""


def write_campaign_page(folder: Path) -> Summary:
    """
    Write the summary and the page of a campaign to its folder, and return the summary.

    Raise DdctError for a folder without a finished campaign, and when a file cannot be written.
    """
    recorded = RecordedCampaign.read(folder)
    results = grouped_rows(recorded, read_table(folder, recorded))
    summary = summary_of(results)
    replay = texts.replay_command('.', 'INDEX')
    page = campaign_page(results, summary, replay, facts_of(recorded))
    with locked_folders(folder):
        write_json(str(folder / SUMMARY), SummaryFile.of(summary))
        write_text(str(folder / PAGE), page)
        keep_digests([folder / SUMMARY, folder / PAGE])
        if (folder / MANIFEST).exists():  # else it is a part of another result
            finish_manifest(folder)
    return summary


def scenario_of(recorded: RecordedCampaign) -> str:
    """Return what the runs of a campaign drive, by name, or that it was varied."""
    plan = recorded.plan
    if {*CHOICES} & {*plan.grid}:
        return 'varied'
    given = [str(plan.spec[key]) for key in CHOICES if key in plan.spec]
    return ', '.join(given) or DEFAULT_SCENARIO


def facts_of(recorded: RecordedCampaign) -> dict[str, str]:
    """Return the origin of a campaign as text by label."""
    plan, origin = recorded.plan, recorded.origin
    common = {key: plan.spec[key] for key in COMMON if key in plan.spec}
    limits = plan.limits.origin
    return {
        **common,
        SCENARIO: scenario_of(recorded),
        'root seed': str(plan.root_seed),
        'limits': f'{limits.get("name")}, digest {limits.get("digest")}',
        'version of the runs': origin.version,
        'commit': origin.commit,
        'digest of the specification': plan.spec_digest,
        'specification': dump_yaml(dict(plan.spec)),
    }


def campaign_page(
    results: GroupedRows, summary: Summary, replay: str, facts: Mapping[str, str]
) -> str:
    """
    Return the HTML page of a campaign; `facts` describe its origin.

    `replay` is the command that makes the bag of the run INDEX.
    """
    maps = campaign_maps(results)
    return page_template(_ROOM, 'campaign.html.j2').render(
        marker=Markup(MARKER),
        style=page_part(DOCUMENTS, 'page.css') + page_part(_ROOM, 'campaign.css'),
        script=page_part(DOCUMENTS, 'page.js') + page_part(_ROOM, 'campaign.js'),
        data=json_data({'maps': to_json(maps), 'ramp': _ramp(), 'replay': replay}),
        maps=maps,
        chosen=_chosen(maps.quantities) if maps else 0,
        summary=summary,
        labels=[group.label for group in results.groups],
        lines=results.lines,
        distributions=_distributions(results, facts[SCENARIO]),
        main=MAIN,
        texts=texts,
        value_text=value_text,
        number_text=number_text,
        quantities={quantity.key: quantity for quantity in results.quantities},
        first=[metric.key for metric in TABLE_5_1],
        replay=replay,
        facts=facts,
        version=package_version(),
    )


def _distributions(results: GroupedRows, scenario: str) -> str:
    """Return the figure of the distributions, encoded for a data URI."""
    with chart_style():
        figure = matplotlib_figure(distributions_chart(results, scenario))
        return b64encode(chart_bytes(figure, 'svg')).decode()


def _chosen(quantities: Sequence[MapScale]) -> int:
    """Return the index of the quantity that the maps show when the page opens."""
    keys = [each.key for each in quantities]
    return next((keys.index(key) for key in _SHOWN_FIRST if key in keys), 0)


@cache
def _ramp() -> tuple[str, ...]:
    """
    Return colours from dark to light, readable for colour-blind people.

    They are those of Nunez, Anderton and Renslow 2018.
    """
    import matplotlib as mpl

    return tuple(mpl.colors.to_hex(mpl.colormaps['cividis'](place / 15)) for place in range(16))
