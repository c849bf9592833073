"""What goes wrong, in words."""


class AleError(Exception):
    """The core or the operating system refused; the text says what and where."""
