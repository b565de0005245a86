"""The command line: `render`, `accuracy` and `compare`."""


class CommandError(Exception):
    """A command that cannot be done; the message is for the user."""

    def __init__(self, message: str, exit_code: int = 1) -> None:
        super().__init__(message)
        self.exit_code = exit_code
        """1: it failed. 2: it asked for something that does not exist."""
