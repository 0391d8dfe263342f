"""What goes wrong, as exceptions."""


class SkeinError(RuntimeError):
    """A command failed; the message is what it said."""


class NotFound(SkeinError):
    """Java 25 or Skein's own files are missing; the message says what was looked for, and where."""
