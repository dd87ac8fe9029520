# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plan of one run: settings, controller, process layout and node parameters."""

from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from ddct_bringup.processes.graph_nodes import ANSWER_TIMEOUT_S, nodes_of
from ddct_controllers.architecture import loop_needs
from ddct_controllers.handover.laws import make_handover
from ddct_controllers.registry import Chosen, compiled_code, controller_label
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import options_of
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.graph.domain import require_domain, require_ros
from ddct_plant.graph.node_names import name_in_graph
from ddct_plant.graph.node_reports import CONTROL_NODES
from ddct_plant.program.own_process import ProcessEndedError
from ddct_plant.program.scheduling import Scheduling
from ddct_plant.scenario.file import scenario_to_yaml
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import UNKNOWN, RunSettings
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
        # The run of compiled code that crashes fails by that, and others go on.
        with suppress(ProcessEndedError):
            loop_needs(self.controller, self.settings)
        if self.settings.shift:
            make_handover(self.settings)
        if self.layout == 'headless':
            require_headless(self.settings)
        else:
            self._require_process_for_compiled_code()
            if not isinstance(self.controller, str):
                raise ParameterError(
                    f'controller {self.name!r} is known to this process alone: run it headless, '
                    'or give a name or a file, which the nodes of a graph can find',
                    key=self.name,
                )
            require_ros()
            require_domain()

    def _require_process_for_compiled_code(self) -> None:
        """Raise ParameterError where compiled code would share its process with other nodes."""
        if self.layout == 'single-process' and compiled_code(self.controller):
            raise ParameterError(
                f'controller {self.name!r} is compiled code, a crash of which would end all nodes '
                'of one process: drop --single-process, or take --headless',
                key='--single-process',
            )

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

        Every node has the known settings, and those that do not control the true ones besides.
        The scenarios, changes included, are written into the folder `work` for the nodes to read.
        """
        two_input, preview_steps = loop_needs(self.controller, self.settings)
        parameters: dict[str, dict[str, object]] = {
            '*': {
                **_settings_parameters(self.settings.known, work),
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
            'reference': {'preview_steps': preview_steps},
            'controller': {'controller': self.controller},
            'driveline': {'require_recorder': True, 'answer_timeout_s': ANSWER_TIMEOUT_S},
        }
        true = _true_parameters(self.settings, work)
        for node in nodes_of(shift=self.settings.shift):
            own = parameters.setdefault(node.path, {})
            if node.namespace:
                own['role'] = OFF_GOING
            if name_in_graph(node.path) not in CONTROL_NODES:
                own.update(true)
        return parameters

    def write_parameter_file(self, folder: Path, work: Path) -> Path:
        """Write `node_parameters` as a ROS 2 parameter file into `work` and return its path."""
        path = work / 'parameters.yaml'
        content = {
            '/**' if node == '*' else f'/**/{node}': {'ros__parameters': parameters}
            for node, parameters in self.node_parameters(folder, work).items()
        }
        path.write_text(dump_yaml(content), encoding='utf-8')
        return path


def _settings_parameters(settings: RunSettings, work: Path) -> dict[str, object]:
    """Return the parameters of settings that controllers know; write the scenario into `work`."""
    return {
        'scenario': _written(settings.scenario, work),
        **{
            name: option.kind(getattr(settings, name))
            for name, option in options_of(RunSettings).items()
            if name not in UNKNOWN
        },
    }


def _true_parameters(settings: RunSettings, work: Path) -> dict[str, object]:
    """Return the parameters that controllers do not have; write the scenario into `work`."""
    options = options_of(RunSettings)
    true: dict[str, object] = {
        name: options[name].kind(getattr(settings, name)) for name in UNKNOWN
    }
    if settings.known_scenario is not None:
        true |= {
            'scenario': _written(settings.scenario, work, 'true_'),
            'known_scenario': _written(settings.known_scenario, work),
        }
    return true


def _written(scenario: Scenario, work: Path, prefix: str = '') -> str:
    """Write a scenario into `work`; return the path of its file."""
    file = work / f'{prefix}{scenario.name}.yaml'
    file.write_text(scenario_to_yaml(scenario), encoding='utf-8')
    return str(file)


def require_headless(settings: RunSettings) -> None:
    """Raise ParameterError where a run needs the graph, as in real time."""
    if not settings.lockstep:
        raise ParameterError(
            'mode realtime needs the graph, which --headless does without: drop one of them',
            key='mode',
        )
