"""Controllers by name: our own, those that other packages add, and those in a file."""

import importlib.metadata
from collections.abc import Callable, Mapping

from ddct_controllers.designed import DesignedController, is_designed_file, load_designed
from ddct_controllers.interface import Controller, ControllerContext
from ddct_controllers.linear import LinearController
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_controllers.pi import make_pi
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_controllers.state_of_art.controllers import STATE_OF_ART
from ddct_controllers.synthesised import SYNTHESISED, synthesised_controller
from ddct_plant.base.checks import require_name
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.scenario.settings import RunSettings

ENTRY_POINT_GROUP = 'ddct.controllers'
"""Third parties add `name = module:factory` here; the factory takes a ControllerContext."""

Factory = Callable[[ControllerContext], Controller]


def controller_names() -> list[str]:
    """Return every name that `make_controller` takes besides files, our own first."""
    own = list(_own_factories())
    return own + sorted(point.name for point in _entry_points() if point.name not in own)


def make_controller(name: str, settings: RunSettings) -> Controller:
    """
    Build the controller called `name`, or described by the YAML file `name`, for a run.

    Raise ParameterError for an unknown name or a gain that the controller does not take, and
    DdctError when a file cannot be read or a third party's factory fails.
    """
    if is_designed_file(name):
        designed = _load_designed(name)
        name, factory = designed.name, _linear_factory(designed.name, designed.sampled())
    else:
        factory = _own_factories().get(name) or _third_party_factory(name)
    gains = settings.scenario.controllers.get(name, {})
    controller = factory(ControllerContext(settings, gains))
    controller.registered_name = name
    return controller


def controller_label(name: str) -> str:
    """Return what a controller is called in bags and tables: a file gives its own name."""
    return _load_designed(name).name if is_designed_file(name) else name


def _load_designed(file: str) -> DesignedController:
    designed = load_designed(file)
    if designed.name in controller_names():
        raise ParameterError(
            f'controller file {file}: the name {designed.name!r} is taken by another controller; '
            'change it in the file'
        )
    return designed


def _own_factories() -> Mapping[str, Factory]:
    printed = {name: _linear_factory(name, g_c) for name, g_c in PRINTED_CONTROLLERS.items()}
    synthesised = {name: _synthesised_factory(name) for name in SYNTHESISED}
    return {'pi': make_pi, **printed, **synthesised, **PREDICTIVE, **STATE_OF_ART}


def _synthesised_factory(name: str) -> Factory:
    return lambda context: _linear_factory(name, synthesised_controller(name))(context)


def _linear_factory(name: str, model: FactoredTransferFunction | StateSpace) -> Factory:
    def make(context: ControllerContext) -> Controller:
        if context.gains:
            raise ParameterError(
                f'controllers.{name}: {", ".join(context.gains)} given, but this controller is '
                'a given transfer function and takes no gains'
            )
        return LinearController(model)

    return make


def _third_party_factory(name: str) -> Factory:
    for point in _entry_points():
        if point.name == name:
            require_name('controller name', name)  # it names the folder of the bag
            return _loaded(point)
    choices = ', '.join(controller_names())
    raise ParameterError(
        f'unknown controller {name!r}: choose from {choices}, or give the path of a YAML file'
    )


def _loaded(point: importlib.metadata.EntryPoint) -> Factory:
    try:
        factory = point.load()
    except Exception as error:
        raise DdctError(
            f'controller {point.name!r}: the entry point {point.value} cannot be loaded '
            f'({type(error).__name__}: {error}): mend or uninstall the package that adds it'
        ) from error

    def make(context: ControllerContext) -> Controller:
        try:
            controller = factory(context)
        except DdctError:
            raise
        except Exception as error:
            raise DdctError(
                f'controller {point.name!r}: {point.value} failed '
                f'({type(error).__name__}: {error}): mend the package that adds it'
            ) from error
        if not isinstance(controller, Controller):
            raise DdctError(
                f'controller {point.name!r}: {point.value} returned '
                f'{type(controller).__name__}, not a ddct_controllers.interface.Controller'
            )
        _require_plain(point.name, controller)
        return controller

    return make


def _require_plain(name: str, controller: Controller) -> None:
    """Raise DdctError unless what the graph is built from is of the declared types."""
    preview = controller.preview_steps
    if type(preview) is not int or preview < 0:
        raise DdctError(
            f'controller {name!r}: its preview_steps is {preview!r}: give a whole number of steps'
        )
    if type(controller.commands_engine) is not bool:
        raise DdctError(
            f'controller {name!r}: its commands_engine is {controller.commands_engine!r}: '
            'give True or False'
        )


def _entry_points() -> importlib.metadata.EntryPoints:
    return importlib.metadata.entry_points(group=ENTRY_POINT_GROUP)
