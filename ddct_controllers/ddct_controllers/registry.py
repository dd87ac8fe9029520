"""Controllers by name: those of this package and those that other packages add."""

import importlib.metadata
from collections.abc import Callable, Mapping

from ddct_controllers.interface import Controller, ControllerContext
from ddct_controllers.linear import LinearController
from ddct_controllers.pi import make_pi
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.errors import DdctError, ParameterError
from ddct_plant.run_settings import RunSettings

ENTRY_POINT_GROUP = 'ddct.controllers'
"""Third parties add `name = module:factory` here; the factory takes a ControllerContext."""

Factory = Callable[[ControllerContext], Controller]


def controller_names() -> list[str]:
    """Return every name that `make_controller` takes, our own first."""
    own = list(_own_factories())
    return own + sorted(point.name for point in _entry_points() if point.name not in own)


def make_controller(name: str, settings: RunSettings) -> Controller:
    """
    Build the controller called `name` for a run with these settings.

    Raise ParameterError for an unknown name or a gain that the controller does not take, and
    DdctError when a third party's factory fails.
    """
    factory = _own_factories().get(name) or _third_party_factory(name)
    gains = settings.scenario.controllers.get(name, {})
    return factory(ControllerContext(settings, gains))


def _own_factories() -> Mapping[str, Factory]:
    printed = {name: _printed_factory(name) for name in PRINTED_CONTROLLERS}
    return {'pi': make_pi, **printed}


def _printed_factory(name: str) -> Factory:
    def make(context: ControllerContext) -> Controller:
        if context.gains:
            raise ParameterError(
                f'controllers.{name}: {", ".join(context.gains)} given, but this controller is '
                'the printed transfer function and takes no gains'
            )
        return LinearController(PRINTED_CONTROLLERS[name])

    return make


def _third_party_factory(name: str) -> Factory:
    for point in _entry_points():
        if point.name == name:
            return _loaded(point)
    choices = ', '.join(controller_names())
    raise ParameterError(f'unknown controller {name!r}: choose from {choices}')


def _loaded(point: importlib.metadata.EntryPoint) -> Factory:
    try:
        factory = point.load()
    except Exception as error:
        raise DdctError(
            f'controller {point.name!r}: its entry point {point.value} cannot be loaded '
            f'({type(error).__name__}: {error}): mend or uninstall the package that adds it'
        ) from error

    def make(context: ControllerContext) -> Controller:
        controller = factory(context)
        if not isinstance(controller, Controller):
            raise DdctError(
                f'controller {point.name!r}: {point.value} returned '
                f'{type(controller).__name__}, not a ddct_controllers.interface.Controller'
            )
        return controller

    return make


def _entry_points() -> importlib.metadata.EntryPoints:
    return importlib.metadata.entry_points(group=ENTRY_POINT_GROUP)
