# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write the summary and the page of a campaign into its folder."""

from pathlib import Path

from ddct_bringup.campaign.keys import COMMON, SCENARIO
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign_report import texts
from ddct_bringup.campaign_report.document import PageParts, campaign_document
from ddct_bringup.campaign_report.reading import grouped_rows, read_table
from ddct_bringup.documents.document import Document
from ddct_bringup.documents.page import html_page
from ddct_bringup.documents.terminal import print_document
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.evaluation.summary import Summary, SummaryFile
from ddct_bringup.manifest.inputs import own_place
from ddct_bringup.manifest.manifest import MANIFEST, finish_manifest, keep_digests
from ddct_bringup.run.output_folder import locked_folders
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import write_text
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.scenario.choices.scenarios import CHOICES, DEFAULT_SCENARIO

SUMMARY, PAGE = 'summary.json', 'report.html'


def write_campaign_page(folder: Path) -> Summary:
    """
    Write the summary and the page of a campaign to its folder, and return the summary.

    Raise DdctError for a folder without a finished campaign, and when a file cannot be written.
    """
    summary, document = _summarised(folder, '.')
    with locked_folders(folder):
        write_json(str(folder / SUMMARY), SummaryFile.of(summary))
        write_text(str(folder / PAGE), html_page(document))
        keep_digests([folder / SUMMARY, folder / PAGE])
        if (folder / MANIFEST).exists():  # else it is a part of another result
            finish_manifest(folder)
    return summary


def campaign_in(folder: Path) -> Document:
    """Return the document of the campaign in a folder; raise DdctError without a finished one."""
    return _summarised(folder, str(folder))[1]


def _summarised(folder: Path, named: str) -> tuple[Summary, Document]:
    """Return the summary and the document of a campaign; commands have the `named` folder."""
    recorded = RecordedCampaign.read(folder)
    results = grouped_rows(recorded, read_table(folder, recorded))
    summary = summary_of(results)
    replay = texts.replay_command(named, 'INDEX')
    return summary, campaign_document(summary, replay, PageParts(results, facts_of(recorded)))


def print_campaign(summary: Summary, folder: Path) -> None:
    """Print the document of the campaign in a folder."""
    print_document(campaign_document(summary, texts.replay_command(str(folder), 'INDEX')))


def scenario_of(recorded: RecordedCampaign) -> str:
    """Return what the runs of a campaign drive, by name, or that it was varied."""
    plan = recorded.plan
    if {*CHOICES} & {*plan.grid}:
        return 'varied'
    given = [own_place(str(plan.spec[key])) for key in CHOICES if key in plan.spec]
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
