"""A campaign's folder: its results are read here, its summary and its page are written here."""

from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as parquet

from ddct_bringup.campaign.columns import INDEX, SCHEMA_VERSION, schema_of
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign.keys import COMMON, SCENARIO, option_of
from ddct_bringup.campaign.manifest import Manifest
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.campaign_report.page import campaign_page
from ddct_bringup.campaign_report.results import Results
from ddct_bringup.campaign_report.summary import Summary, summary_of
from ddct_bringup.run.folder_lock import held
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.output_file import write_json, write_text
from ddct_plant.files.schema_version import KEY, require_schema_version
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.models.clutch import LINEAR
from ddct_plant.scenario.differences import values_by_key
from ddct_plant.scenario.file import is_packaged, load_scenario
from ddct_plant.scenario.settings import RunSettings

SUMMARY, PAGE = 'summary.json', 'report.html'
_AGAIN = 'give --resume to ddct campaign, which writes it from what is done'


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
        require_schema_version({KEY: int(known.get(KEY.encode(), 0))}, SCHEMA_VERSION)
    except FileNotFoundError as error:
        raise DdctError(
            f'{folder}: no {RESULTS} in it, so the campaign is not finished: {_AGAIN}'
        ) from error
    except ParameterError as error:
        raise DdctError(f'{path}: {error}') from error
    except (OSError, ValueError, pa.ArrowException) as error:
        raise DdctError(f'{path}: it is damaged ({_first_line(error)}): {_AGAIN}') from error
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
    name = common.pop(SCENARIO)
    file = name if is_packaged(name) else str(spec.folder / name)
    scenario = load_scenario(file, clutch=common.get('clutch', LINEAR))
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


def _first_line(error: Exception) -> str:
    return next(iter(str(error).splitlines()), type(error).__name__)
