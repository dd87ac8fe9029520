"""The controller of Section 3.2.2 as the synthesis gives it, before it is cleaned."""

from ddct_plant.linear.lti import FactoredTransferFunction

RAW_CONTROLLER = FactoredTransferFunction(
    gain=-434.85,
    numerator=(0.7567, 0.009368, 0.004946, (82.23, 2563.0), (121.4, 7696.0), (134.1, 4.27e4)),
    denominator=(
        *(1.418e5, 138.0, 89.52, 0.005905),
        (0.01896, 9.053e-5),
        (5.344, 339.4),
        (146.2, 2.914e4),
    ),
)
"""G_c(s) of hinflmi, as printed."""
