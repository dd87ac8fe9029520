"""Where the runs come from and with which parameters, as the bags tell."""

from dataclasses import dataclass

from ddct_bringup.bag.reader import Recording
from ddct_bringup.report.runs import ReportRun
from ddct_bringup.run.source_commit import UNKNOWN, short_commit

_CONDITIONS = ('controller', 'architecture', 'clutch', 'wear_gain', 'mode', 'seed')
_REPEATED = ('version', 'scenario', 'scenario_digest', 'computed_from', *_CONDITIONS[1:])
"""What every node says and the page has elsewhere."""


@dataclass(frozen=True)
class RunOrigin:
    """Of one run its conditions, and what each node said of itself."""

    conditions: tuple[tuple[str, str], ...]
    nodes: tuple[tuple[str, tuple[tuple[str, str], ...]], ...]
    commit: str
    version: str

    @property
    def short_commit(self) -> str:
        """The commit for a narrow column."""
        return short_commit(self.commit)


def scenario_text(recording: Recording) -> str:
    """Return the whole scenario as YAML, empty where the bag does not hold it."""
    return recording.custom_data.get('scenario_yaml', '')


def run_origin(run: ReportRun) -> RunOrigin:
    """Return the origin of a run, with dashes for what an unreadable bag does not tell."""
    conditions = tuple(
        (name, '–' if run.entry[name] is None else str(run.entry[name])) for name in _CONDITIONS
    )
    told = {} if run.recording is None else run.recording.run_info.get('controller', {})
    conditions += (('computed_from', told.get('computed_from', '–')),)
    if run.recording is None:
        return RunOrigin(conditions, (), '–', '–')
    nodes = {
        node: tuple((key, value) for key, value in pairs.items() if key not in _REPEATED)
        for node, pairs in sorted(run.recording.run_info.items())
    }
    custom = run.recording.custom_data
    return RunOrigin(
        conditions,
        tuple((node, pairs) for node, pairs in nodes.items() if pairs),
        custom.get('commit', UNKNOWN),
        custom.get('version', UNKNOWN),
    )
