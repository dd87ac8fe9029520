"""A campaign's folder: its results are read here, its summary and its page are written here."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pyarrow as pa
import pyarrow.parquet as parquet
from markupsafe import Markup

from ddct_bringup.campaign.columns import INDEX, SCHEMA_VERSION, schema_of
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign.keys import COMMON, SCENARIO, option_of
from ddct_bringup.campaign.manifest import Manifest
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.campaign_report import words
from ddct_bringup.campaign_report.maps import FAILED_SHARE, campaign_maps
from ddct_bringup.campaign_report.results import Results
from ddct_bringup.campaign_report.summary import Summary, summary_of
from ddct_bringup.report.page_parts import (
    MARKER,
    json_data,
    number_text,
    page_part,
    page_template,
    value_text,
)
from ddct_bringup.run.output_folder import held
from ddct_bringup.verdict.metric_figures import TABLE_5_1
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import SCHEMA_KEY, require_schema_version
from ddct_plant.files.output_file import write_json, write_text
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.models.clutch import LINEAR
from ddct_plant.program.command_line import package_version
from ddct_plant.scenario.differences import values_by_key
from ddct_plant.scenario.settings import RunSettings

SUMMARY, PAGE = 'summary.json', 'report.html'
_AGAIN = 'give --resume to ddct campaign, which writes it from what is done'
_ROOM, _REPORT = 'ddct_bringup.campaign_report', 'ddct_bringup.report'
_RAMP = tuple(mpl.colors.to_hex(mpl.colormaps['cividis'](place / 15)) for place in range(16))
"""Dark to light, made for colour-blind eyes (Nunez, Anderton and Renslow 2018)."""
_SHOWN_FIRST = (FAILED_SHARE, 'peak_jerk_m_s3')
"""The quantity of the maps when the page opens: the first of these that there is."""


def write_campaign_page(folder: Path) -> Summary:
    """
    Write the summary and the page of a campaign into its folder, and return the summary.

    Raise DdctError for a folder that is no finished campaign, and when a file cannot be written.
    """
    manifest = Manifest.read(folder)
    results = results_of(manifest, read_table(folder, manifest))
    summary = summary_of(results)
    page = campaign_page(results, summary, folder.as_posix(), _facts(manifest))
    with held(folder):
        write_json(str(folder / SUMMARY), summary)
        write_text(str(folder / PAGE), page)
    return summary


def read_table(folder: Path, manifest: Manifest) -> pa.Table:
    """Return the rows of a finished campaign; raise DdctError without them."""
    path = folder / RESULTS
    try:
        table = parquet.read_table(path)
        known = table.schema.metadata or {}
        require_schema_version(
            {SCHEMA_KEY: int(known.get(SCHEMA_KEY.encode(), 0))}, SCHEMA_VERSION
        )
    except FileNotFoundError as error:
        raise DdctError(
            f'{folder}: no {RESULTS} in it, so the campaign is not finished: {_AGAIN}'
        ) from error
    except ParameterError as error:
        raise DdctError(f'{path}: {error}') from error
    except (OSError, ValueError, pa.ArrowException) as error:
        why = next(iter(str(error).splitlines()), type(error).__name__)
        raise DdctError(f'{path}: it is damaged ({why}): {_AGAIN}') from error
    schema = schema_of(manifest.campaign_spec())
    if not table.schema.equals(schema) or table[INDEX].to_pylist() != list(range(manifest.runs)):
        raise DdctError(f'{path}: it is not what {folder} was started with: {_AGAIN}')
    return table


def results_of(manifest: Manifest, table: pa.Table) -> Results:
    """Return the rows with what the manifest says of them."""
    spec = manifest.campaign_spec()
    columns = {name: table[name].to_numpy() for name in table.column_names}
    return Results(columns, tuple(spec.grid), tuple(spec.vary), nominal_values(spec))


def nominal_values(spec: CampaignSpec) -> dict[str, float]:
    """
    Return the numbers that a specification varies as they are without it.

    That is in its scenario, the first of several; of what the scenario leaves out, by default.
    Raise DdctError for a scenario that cannot be read any more.
    """
    first = {key: spec.values_of(key)[0] for key in COMMON if key in spec.keys}
    common = {**spec.common, **first}
    file = spec.scenario_file(common.pop(SCENARIO))
    scenario = file.scenario(clutch=common.get('clutch', LINEAR))
    given = {**vars(RunSettings(scenario, **common)), **values_by_key(scenario)}
    found: dict[str, float] = {}
    for key in spec.keys:
        option = option_of(key, key)
        value = given.get(key, option.default if option else None)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            found[key] = float(value)
    return found


def _facts(manifest: Manifest) -> dict[str, Any]:
    """Return in words where a campaign is from."""
    common = {SCENARIO: 'varied', **manifest.campaign_spec().common}
    limits = manifest.limits
    return {
        **common,
        'root seed': str(manifest.root_seed),
        'limits': f'{limits.get("name")}, digest {limits.get("digest")}',
        'version of the runs': manifest.version,
        'commit': manifest.commit,
        'digest of the specification': manifest.spec_digest,
        'specification': dump_yaml(manifest.spec),
    }


def campaign_page(
    results: Results, summary: Summary, folder: str, facts: Mapping[str, str]
) -> str:
    """Return the HTML over a campaign in a folder; `facts` are words about where it is from."""
    maps = campaign_maps(results)
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
        figures={figure.key: figure for figure in results.quantities},
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
