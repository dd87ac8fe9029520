# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plan of one run: settings, controller, process layout and node parameters."""

from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from ddct_bringup.processes.graph_names import GraphNames
from ddct_bringup.processes.graph_nodes import ANSWER_TIMEOUT_S, NodeArguments, nodes_of
from ddct_controllers.architecture import loop_needs
from ddct_controllers.handover.laws import make_handover
from ddct_controllers.registry import Chosen, controller_label
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import time_of_step
from ddct_plant.files.json_records import write_json
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.graph.domain import require_domain, require_ros
from ddct_plant.graph.node_names import name_in_graph
from ddct_plant.graph.node_reports import CONTROL_NODES
from ddct_plant.program.command_line import ROS_ARGUMENTS
from ddct_plant.program.own_process import ProcessEndedError
from ddct_plant.scenario.recorded_settings import RecordedSettings
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.roles import OFF_GOING

LAYOUTS = ('processes', 'single-process', 'headless')
"""Process layouts: one process per node, one for all, and without ROS."""
SIDES = CONTROL, PLANT = 'control', 'plant'
"""Folders for the files of nodes that have the known settings alone, and of the others."""


@dataclass(frozen=True)
class RunPlan:
    """Plan of one run; building it checks that the run can be built."""

    settings: RunSettings
    controller: Chosen
    """Controller to run; in a graph a name of the registry or the path of a controller file."""
    layout: str = 'processes'
    """Process layout, one of LAYOUTS."""
    names: GraphNames = field(default_factory=GraphNames)
    """Names of the graph in ROS, which change nothing in its bag."""

    def __post_init__(self) -> None:
        """Raise DdctError for a plan that would fail in the graph."""
        # The run of compiled code that crashes fails by that, and others go on.
        with suppress(ProcessEndedError):
            loop_needs(self.controller, self.settings.known)
        if self.settings.shift:
            make_handover(self.settings.known)
        if self.layout == 'headless':
            require_headless(self.settings)
            if self.names != GraphNames():
                raise ParameterError(
                    f'{ROS_ARGUMENTS} names nodes and topics, which --headless does without: drop '
                    'one of them',
                    key=ROS_ARGUMENTS,
                )
        else:
            if not isinstance(self.controller, str):
                raise ParameterError(
                    f'controller {self.name!r} is known to this process alone: run it headless, '
                    'or give a name or a file, which the nodes of a graph can find',
                    key=self.name,
                )
            require_ros()
            require_domain()

    @property
    def name(self) -> str:
        """Name of the controller in bags and tables, and of the bag's folder."""
        return controller_label(self.controller)

    @property
    def steps(self) -> int:
        """N, the number of periods."""
        return self.settings.scenario.steps

    def node_parameters(self, folder: Path, work: Path) -> dict[str, dict[str, object]]:
        """
        Return the ROS parameters by node path for a bag in `folder`; '*' is every node.

        The settings of the run are written below the folder `work`, in a file for each part. Every
        node gets the known ones, and those that do not control the case besides.
        """
        two_input, preview_steps = loop_needs(self.controller, self.settings.known)
        known, case = self._write_settings(work)
        parameters: dict[str, dict[str, object]] = {
            '*': {'known': known},
            'recorder': {'out': str(folder), 'name': self.name, 'two_input': two_input},
            'engine': {'two_input': two_input},
            'reference': {'preview_steps': preview_steps},
            'controller': {'controller': self.controller},
            'driveline': {'require_recorder': True, 'answer_timeout_s': ANSWER_TIMEOUT_S},
        }
        if self.settings.shift:  # the settings have the name of a file alone
            parameters['handover'] = {'handover': self.settings.known.handover}
        for node in nodes_of(shift=self.settings.shift):
            own = parameters.setdefault(node.path, {})
            if node.namespace:
                own['role'] = OFF_GOING
            if name_in_graph(node.path) not in CONTROL_NODES:
                own['case'] = case
        return parameters

    def _write_settings(self, work: Path) -> tuple[str, str]:
        """Write the settings of the run into `work`; return the files of their two parts."""
        recorded = RecordedSettings.of(self.settings, self.name, time_of_step(self.steps))
        for name in SIDES:
            (work / name).mkdir(exist_ok=True)
        files = str(work / CONTROL / 'known.json'), str(work / PLANT / 'case.json')
        for file, part in zip(files, recorded.parts, strict=True):
            write_json(file, part)
        return files

    def write_parameter_files(self, folder: Path, work: Path) -> NodeArguments:
        """Write `node_parameters` as ROS 2 parameter files below `work`; return the arguments."""
        contents: dict[str, dict[str, object]] = {name: {} for name in SIDES}
        for node, parameters in self.node_parameters(folder, work).items():
            every = node == '*'
            section = {'/**' if every else f'/**/{node}': {'ros__parameters': parameters}}
            controls = name_in_graph(node) in CONTROL_NODES
            for name in SIDES if every else (CONTROL,) if controls else (PLANT,):
                contents[name] |= section
        files = {name: work / name / 'parameters.yaml' for name in SIDES}
        for name, content in contents.items():
            files[name].write_text(dump_yaml(content), encoding='utf-8')
        return NodeArguments(files[CONTROL], files[PLANT], self.names)


def require_headless(settings: RunSettings) -> None:
    """Raise ParameterError where a run needs the graph, as in real time."""
    if not settings.known.lockstep:
        raise ParameterError(
            'mode realtime needs the graph, which --headless does without: drop one of them',
            key='mode',
        )
