"""What `design` writes: a continuous linear controller and where it comes from, as a file."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ddct_controllers.from_file.controller_file import (
    FORMAT,
    read_controller_file,
    require_name,
)
from ddct_controllers.from_file.transfer_functions import FACTORED, FREQUENCY, UNITS, linear_in
from ddct_controllers.linear import HOLD, sampled
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace

_FACTORS = ('numerator', 'denominator')


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
        self.sampled()

    def sampled(self) -> StateSpace:
        """Return G_c(z) at 10 ms."""
        return sampled(self.transfer_function, self.discretisation)

    def to_yaml(self) -> str:
        """Return the text that `load_designed` reads back to the same controller, to the bit."""
        content = {
            'format': FORMAT,
            'name': self.name,
            'units': {**UNITS, **FREQUENCY},
            **({} if self.discretisation == HOLD else {'discretisation': self.discretisation}),
            FACTORED: {
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
    """Read what `design` wrote; raise DdctError that names file, key and remedy."""
    source = read_controller_file(file)
    with source.located():
        function, discretisation = linear_in(source, FACTORED)
        if not isinstance(function, FactoredTransferFunction):
            raise ParameterError('sample_time_s is given: a design is continuous')
        provenance = source.content.get('provenance') or {}
        return DesignedController(source.name, function, provenance, discretisation)


def _plain(factor: Factor) -> float | list[float]:
    return [float(x) for x in factor] if isinstance(factor, tuple) else float(factor)
