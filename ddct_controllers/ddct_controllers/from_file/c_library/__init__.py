"""Controllers written in C: the interface of the shared library, and the process that calls it."""
