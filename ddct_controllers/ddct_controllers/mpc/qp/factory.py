"""QP backends by name; only the chosen one's module and solver are imported."""

from importlib import import_module

from ddct_controllers.mpc.qp.backend import QpBackend
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.base.checks import require_choice

_CLASSES = {'daqp': 'DaqpBackend', 'osqp': 'OsqpBackend'}

BACKENDS = tuple(_CLASSES)
DEFAULT_BACKEND = 'daqp'
"""The fastest at equal accuracy; `make bench` measures both."""
ITERATION_LIMITS = {'daqp': 1000, 'osqp': 20_000}
"""Ten and four times what the hardest programs of `make bench` need; OSQP's are far cheaper."""


def make_backend(
    name: str, structure: QpStructure, iteration_limit: int | None = None
) -> QpBackend:
    """
    Return the backend called `name` for programs of `structure`; its own limit if none is given.

    Raise ParameterError for an unknown name or a limit below 1, DdctError when the backend's
    package is not installed.
    """
    require_choice('QP backend', name, BACKENDS)
    limit = ITERATION_LIMITS[name] if iteration_limit is None else iteration_limit
    module = import_module(f'ddct_controllers.mpc.qp.{name}_backend')
    backend: QpBackend = getattr(module, _CLASSES[name])(structure, limit)
    return backend
