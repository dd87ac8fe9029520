"""Loop shaping (Chapter 2): specifications, networks, Nyquist and Nichols, search."""
