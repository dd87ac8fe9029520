"""What the engine says of itself, in a graph or without one."""

from ddct_plant.fail_safe.request_watch import REQUEST_TIMEOUT_S


def engine_info(two_input: bool, request_timeout_s: float = REQUEST_TIMEOUT_S) -> dict[str, str]:
    """Return whether it waits for a controller's requests, and for how long [s] in real time."""
    return {'two_input': str(two_input).lower(), 'request_timeout_s': repr(request_timeout_s)}
