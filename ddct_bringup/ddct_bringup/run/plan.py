# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plan of one run: settings, controller, process layout and node parameters."""

from dataclasses import dataclass, field
from pathlib import Path

from ddct_bringup.processes.graph_nodes import ANSWER_TIMEOUT_S, nodes_of
from ddct_controllers.architecture import make_architecture
from ddct_controllers.handover.laws import make_handover
from ddct_controllers.registry import Chosen, controller_label, make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import options_of
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.graph.domain import require_domain, require_ros
from ddct_plant.program.scheduling import Scheduling
from ddct_plant.scenario.file import scenario_to_yaml
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.roles import OFF_GOING


@dataclass(frozen=True)
class RunPlan:
    """Plan of one run; building it checks that the run can be built."""

    settings: RunSettings
    controller: Chosen
    """Controller to run; in a graph a name of the registry or the path of a controller file."""
    layout: str = 'processes'
    """Process layout: 'processes', one per node; 'single-process'; or 'headless', without ROS."""
    scheduling: Scheduling = field(default_factory=Scheduling)
    """How the kernel treats the nodes of a real-time run."""

    def __post_init__(self) -> None:
        """Raise DdctError for a plan that would fail in the graph."""
        self.scheduling.require_mode(lockstep=self.settings.lockstep)
        self.scheduling.require_permitted()
        make_architecture(self.settings, make_controller(self.controller, self.settings))
        if self.settings.shift:
            make_handover(self.settings)
        if self.layout == 'headless':
            require_headless(self.settings)
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

        The scenario, changes included, is written into the folder `work` for the nodes to read.
        """
        scenario_file = work / f'{self.settings.scenario.name}.yaml'
        scenario_file.write_text(scenario_to_yaml(self.settings.scenario), encoding='utf-8')
        controller = make_controller(self.controller, self.settings)
        two_input = controller.commands_engine
        return {
            '*': {
                'scenario': str(scenario_file),
                **{
                    name: option.kind(getattr(self.settings, name))
                    for name, option in options_of(RunSettings).items()
                },
                # Only these: an empty text is no value on the command line of a node.
                **self.scheduling.chosen,
            },
            'recorder': {
                **{'out': str(folder), 'name': self.name, 'two_input': two_input},
                # No step waits for it, so it comes after the others; but before usual programs, as
                # it has locks of the middleware for which the others wait.
                'realtime_priority': max(self.scheduling.realtime_priority - 1, 0),
            },
            'engine': {'two_input': two_input},
            'reference': {'preview_steps': controller.preview_steps},
            'controller': {'controller': self.controller},
            'driveline': {'require_recorder': True, 'answer_timeout_s': ANSWER_TIMEOUT_S},
            **{
                node.path: {'role': OFF_GOING}
                for node in nodes_of(shift=self.settings.shift)
                if node.namespace
            },
        }

    def write_parameter_file(self, folder: Path, work: Path) -> Path:
        """Write `node_parameters` as a ROS 2 parameter file into `work` and return its path."""
        path = work / 'parameters.yaml'
        content = {
            '/**' if node == '*' else f'/**/{node}': {'ros__parameters': parameters}
            for node, parameters in self.node_parameters(folder, work).items()
        }
        path.write_text(dump_yaml(content), encoding='utf-8')
        return path


def require_headless(settings: RunSettings) -> None:
    """Raise ParameterError where a run needs the graph, as in real time."""
    if not settings.lockstep:
        raise ParameterError(
            'mode realtime needs the graph, which --headless does without: drop one of them',
            key='mode',
        )
