"""What the recorder has heard on `run_info`: who is there, and that all run the same."""

from collections.abc import Collection, Mapping

from ddct_bringup.bag.run_facts import RunInfoOfNodes, note_run_info, run_info_order
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.run_info import run_info_pairs
from ddct_plant.graph.topics import RUN_INFO
from ddct_plant.scenario.settings import RunSettings


class HeardNodes:
    """Collect the `run_info` of every node that a recording needs."""

    def __init__(self, settings: RunSettings, two_input: bool, expected: Collection[str]) -> None:
        """Take what the recorder itself runs with, and the names of the nodes to wait for."""
        self._settings = settings
        self._two_input = str(two_input).lower()
        self._expected = set(expected)
        self._said_by: RunInfoOfNodes = {}

    def hear(self, node: str, pairs: Mapping[str, str]) -> None:
        """
        Keep what a node says of itself.

        Raise DdctError when it runs with other settings, or has said something else before.
        """
        for key, ours in run_info_pairs(self._settings):
            if pairs.get(key, ours) != ours:
                raise DdctError(
                    f'node {node} runs with {key} {pairs[key]} and the recorder with {ours}: '
                    'start every node with the same settings'
                )
        if pairs.get('two_input', self._two_input) != self._two_input:
            raise DdctError(
                f'node {node} runs with two_input {pairs["two_input"]} and the recorder with '
                f'{self._two_input}: start engine and recorder with the two_input of the '
                'controller, as --ros-args -p two_input:=true when it commands the engine'
            )
        note_run_info(self._said_by, node, pairs)

    def silent(self) -> list[str]:
        """Return the names of the nodes that have not been heard yet."""
        return sorted(self._expected - set(self._said_by))

    def said(self) -> RunInfoOfNodes:
        """Return what each node said of itself, in the order in which it is recorded."""
        return {node: self._said_by[node] for node in run_info_order(self._said_by)}

    @property
    def controller(self) -> str:
        """The name of the controller; DdctError when nobody has said it."""
        return self._said('controller', 'controller')

    @property
    def steps(self) -> int:
        """N, the number of periods; DdctError when nobody has said it."""
        steps = self._said('driveline', 'steps')
        if not steps.isdecimal():
            raise DdctError(
                f'{RUN_INFO.name} of node driveline has steps {steps!r}: give a whole number'
            )
        return int(steps)

    def _said(self, node: str, key: str) -> str:
        pairs = self._said_by.get(node, {})
        if key not in pairs:
            raise DdctError(
                f'{RUN_INFO.name} of node {node} has no {key}, which the bag needs: whoever '
                f'stands in for {node} must publish it'
            )
        return pairs[key]
