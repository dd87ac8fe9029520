"""Text from files, bags and messages, made fit for a terminal."""

MOST_CHARACTERS = 4000
"""Longer text loses its middle: the beginning says what is wrong, the end what to do."""
_KEPT_AT_END = 1000
_CUT = ' [...] '


def printable(text: object) -> str:
    r"""
    Return `text` as one line without control characters.

    What a terminal would obey or not show (ANSI codes, line ends, marks of direction, lone
    surrogates) is written as an escape such as \x1b.
    """
    line = str(text)
    if len(line) > MOST_CHARACTERS:
        line = line[: MOST_CHARACTERS - _KEPT_AT_END] + _CUT + line[-_KEPT_AT_END:]
    if line.isprintable():
        return line
    return ''.join(
        character if character.isprintable() else character.encode('unicode_escape').decode()
        for character in line
    )
