"""Linear controllers that live in a file: what `design` writes and `--controller FILE` reads."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ddct_controllers.from_file.controller_file import (
    FORMAT,
    ControllerFile,
    mapping,
    read_controller_file,
    require_name,
)
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_controllers.linear import linear_spec
from ddct_plant.base.checks import require_choice
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.linear.bilinear import from_w_plane
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace, discretise_zoh

KIND = 'transfer_function'
UNITS = {'input': 'rpm', 'output': 'N m', 'frequency': 'rad/s'}
"""Of the slip error, the clutch torque, and zeros and poles; nothing else is accepted."""
_FACTORS = ('numerator', 'denominator')
HOLD, BILINEAR = 'hold', 'bilinear'
"""Zero-order hold as the thesis's `c2d`, or z = (1 + s T/2) / (1 - s T/2), both at 10 ms."""


@dataclass(frozen=True)
class DesignedController:
    """A continuous, proper G_c(s) in N m per rpm of slip error, and where it comes from."""

    name: str
    """Names its bag folder: a lower-case letter, then letters, digits and underscores."""
    transfer_function: FactoredTransferFunction
    provenance: Mapping[str, Any] = field(default_factory=dict)
    """Plain values: method, specifications, what was verified."""
    discretisation: str = HOLD
    """HOLD or BILINEAR: a design that had hold and delay in the plant is BILINEAR."""

    def __post_init__(self) -> None:
        """Check name, properness and choice; raise ParameterError that names what is wrong."""
        require_name(self.name)
        require_choice('discretisation', self.discretisation, (HOLD, BILINEAR))
        self.transfer_function.to_state_space()

    def sampled(self) -> StateSpace:
        """Return G_c(z) at 10 ms."""
        realised = self.transfer_function.to_state_space()
        if self.discretisation == BILINEAR:
            return from_w_plane(realised)
        return discretise_zoh(realised, PERIOD_S)

    def to_yaml(self) -> str:
        """Return the text that `load_designed` reads back to the same controller, to the bit."""
        content = {
            'format': FORMAT,
            'name': self.name,
            'units': UNITS,
            **({} if self.discretisation == HOLD else {'discretisation': self.discretisation}),
            KIND: {
                'gain': float(self.transfer_function.gain),
                **{
                    key: [_plain(factor) for factor in getattr(self.transfer_function, key)]
                    for key in _FACTORS
                },
            },
            'provenance': dict(self.provenance),
        }
        return dump_yaml(content, default_flow_style=None)


def load_designed(file: str) -> DesignedController:
    """Read a controller; raise DdctError or ParameterError that names file, key and remedy."""
    source = read_controller_file(file)
    with source.located():
        return _designed(source)


def designed_spec(file: ControllerFile) -> ControllerSpec[Controller]:
    """Return the controller behind `transfer_function`, the factored form of the thesis."""
    designed = _designed(file)
    return linear_spec(designed.name, designed.sampled())


def _designed(file: ControllerFile) -> DesignedController:
    content = file.keys(KIND, ('format', 'units'), ('discretisation',))
    require_units(content['units'])
    parts = mapping(KIND, content[KIND], ('gain', *_FACTORS))
    function = FactoredTransferFunction(
        parts['gain'], *(_factors(f'{KIND}.{key}', parts[key]) for key in _FACTORS)
    )
    discretisation = content.get('discretisation', HOLD)
    provenance = content.get('provenance') or {}
    return DesignedController(content['name'], function, provenance, discretisation)


def require_units(units: Any) -> None:
    """Raise ParameterError unless the file states the units that the program has."""
    if units != UNITS:
        raise ParameterError(f'units are {units!r}: convert the controller to {UNITS}')


def _factors(name: str, content: Any) -> tuple[Factor, ...]:
    if not isinstance(content, list):
        raise ParameterError(f'{name} is {content!r}: give a list, such as [0.0, [5.3, 339.4]]')
    for factor in content:
        if isinstance(factor, list) and len(factor) != 2:
            raise ParameterError(
                f'{name}: {factor} is no factor: write a for (s + a), [b, c] for (s^2 + b s + c)'
            )
    return tuple(tuple(factor) if isinstance(factor, list) else factor for factor in content)


def _plain(factor: Factor) -> float | list[float]:
    return [float(x) for x in factor] if isinstance(factor, tuple) else float(factor)
