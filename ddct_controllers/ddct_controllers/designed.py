"""Linear controllers that live in a file: what `design` writes and `--controller FILE` reads."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ddct_plant.base.checks import require_choice
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.files.input_file import read_text_file
from ddct_plant.files.yaml_text import dump_yaml, parse_yaml
from ddct_plant.linear.bilinear import from_w_plane
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace, discretise_zoh

FORMAT = 'ddct-linear-controller-1'
"""First value of every file; a change of meaning changes the number."""
UNITS = {'input': 'rpm', 'output': 'N m', 'frequency': 'rad/s'}
"""Of the slip error, the clutch torque, and zeros and poles; nothing else is accepted."""
SUFFIXES = ('.yaml', '.yml')
_KEYS = ('format', 'name', 'units', 'transfer_function')
_OPTIONAL_KEYS = ('discretisation', 'provenance')
_FACTORS = ('numerator', 'denominator')
HOLD, BILINEAR = 'hold', 'bilinear'
"""Zero-order hold as the thesis's `c2d`, or z = (1 + s T/2) / (1 - s T/2), both at 10 ms."""
_NAME = re.compile(r'[a-z][a-z0-9_]{0,39}')


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
            'transfer_function': {
                'gain': float(self.transfer_function.gain),
                **{
                    key: [_plain(factor) for factor in getattr(self.transfer_function, key)]
                    for key in _FACTORS
                },
            },
            'provenance': dict(self.provenance),
        }
        return dump_yaml(content, default_flow_style=None)


def require_name(name: object) -> None:
    """Raise ParameterError unless a controller can be called `name`."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise ParameterError(
            f'controller name {name!r}: use up to 40 lower-case letters, digits and underscores, '
            'a letter first'
        )


def is_designed_file(name: str) -> bool:
    """Say whether a controller's name is that of a file."""
    return name.endswith(SUFFIXES)


def load_designed(file: str) -> DesignedController:
    """Read a controller; raise DdctError or ParameterError that names file, key and remedy."""
    path = Path(file)
    try:
        text = read_text_file(path)
    except OSError as error:
        raise DdctError(f'controller file {path}: cannot be read ({error.strerror})') from error
    try:
        return _from_mapping(parse_yaml(text))
    except ParameterError as error:
        raise ParameterError(f'controller file {path}: {error}') from error


def _from_mapping(content: Any) -> DesignedController:
    content = _mapping('the file', content, required=_KEYS, optional=_OPTIONAL_KEYS)
    if content['format'] != FORMAT:
        raise ParameterError(f'format is {content["format"]!r}: it must be {FORMAT}')
    if content['units'] != UNITS:
        raise ParameterError(f'units are {content["units"]!r}: convert the controller to {UNITS}')
    parts = _mapping('transfer_function', content['transfer_function'], ('gain', *_FACTORS))
    function = FactoredTransferFunction(
        parts['gain'], *(_factors(f'transfer_function.{key}', parts[key]) for key in _FACTORS)
    )
    provenance = _mapping('provenance', content.get('provenance') or {})
    discretisation = content.get('discretisation', HOLD)
    return DesignedController(content['name'], function, provenance, discretisation)


def _mapping(
    name: str, content: Any, required: Sequence[str] = (), optional: Sequence[str] = ()
) -> Mapping[str, Any]:
    if not isinstance(content, Mapping):
        raise ParameterError(f'{name}: give keys and values, not {content!r}')
    for key in required:
        if key not in content:
            raise ParameterError(f'{name}: key {key} is missing')
    for key in content if required else ():
        if key not in (*required, *optional):
            known = ', '.join((*required, *optional))
            raise ParameterError(f'{name}: unknown key {key!r}; known: {known}')
    return content


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
