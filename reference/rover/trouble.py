"""One kind of error for bad input, so that the command prints one clear message and ends with code 2."""


class Trouble(Exception):
    """The recording cannot be read or cannot be followed; the text says what, where, and what was expected."""
