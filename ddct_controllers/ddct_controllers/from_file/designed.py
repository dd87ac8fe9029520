# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Files of designed controllers: a continuous linear controller with its provenance."""

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
    """A continuous, proper G_c(s) in N m per rpm of slip error, with its provenance."""

    name: str
    """Name of its bag folder: a lower-case letter, then letters, digits and underscores."""
    transfer_function: FactoredTransferFunction
    provenance: Mapping[str, Any] = field(default_factory=dict)
    """Method, specifications and verified quantities, as plain values."""
    discretisation: str = HOLD
    """Discretisation: HOLD, or BILINEAR for a design with hold and delay in its plant."""

    def __post_init__(self) -> None:
        """Check name, properness and choice; raise ParameterError that names the wrong one."""
        require_name(self.name)
        self.sampled()

    def sampled(self) -> StateSpace:
        """Return G_c(z) at 10 ms."""
        return sampled(self.transfer_function, self.discretisation)

    def to_yaml(self) -> str:
        """Return the text from which `load_designed` restores the same controller, to the bit."""
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
    """Read the file of a design; raise DdctError that names file, key and remedy."""
    source = read_controller_file(file)
    with source.located():
        function, discretisation = linear_in(source, FACTORED)
        if not isinstance(function, FactoredTransferFunction):
            raise ParameterError(
                'sample_time_s is given: a design is continuous', key='sample_time_s'
            )
        provenance = source.content.get('provenance') or {}
        return DesignedController(source.name, function, provenance, discretisation)


def _plain(factor: Factor) -> float | list[float]:
    return [float(x) for x in factor] if isinstance(factor, tuple) else float(factor)
