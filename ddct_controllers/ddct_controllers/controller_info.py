"""What a controller says of itself on `run_info`."""

from ddct_controllers.interface import Controller


def controller_info(name: str, controller: Controller) -> dict[str, str]:
    """Return the registry name and the gains as text, to the last bit."""
    gains = {f'gains.{gain}': repr(value) for gain, value in controller.gains().items()}
    return {'controller': name, **gains}
