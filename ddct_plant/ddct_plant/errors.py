"""Errors that a user can mend; programs print them in one line."""


class DdctError(Exception):
    """Say what is wrong, where, and what to do about it, in one line."""


class ParameterError(DdctError, ValueError):
    """A parameter, option or scenario key has a value that cannot be used."""
