"""The printed z-forms: controllers discretised by zero-order hold at 10 ms."""

from ddct_bringup.reproduction.values.coefficients import coefficients
from ddct_controllers.design.state_space import pulse_transfer_function
from ddct_controllers.printed import PRINTED_CONTROLLERS


def sampled_values(name: str) -> dict[str, float]:
    """Return the coefficients of G_c(z) of a printed controller, in its order, by `NAME(z)...`."""
    return coefficients(f'{name}(z)', pulse_transfer_function(PRINTED_CONTROLLERS[name]))
