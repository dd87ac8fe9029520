"""Take the factors of a printed transfer function for what they are."""

from ddct_plant.linear.cascade import Factor


def real(factor: Factor) -> float:
    """Return a of a factor (s + a)."""
    assert isinstance(factor, float)
    return factor


def pair(factor: Factor) -> tuple[float, float]:
    """Return b and c of a factor (s^2 + b s + c)."""
    assert isinstance(factor, tuple)
    return factor
