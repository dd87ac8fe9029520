"""What a controller says of itself on `run_info`."""

from ddct_controllers.interface import Controller


def controller_info(name: str, controller: Controller) -> dict[str, str]:
    """Return the registry name, whether it commands the engine, and its gains to the last bit."""
    gains = {f'gains.{gain}': repr(value) for gain, value in controller.gains().items()}
    two_input = str(controller.commands_engine).lower()
    return {'controller': name, 'two_input': two_input, **gains}
