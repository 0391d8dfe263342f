"""Exceptions of this package."""


class SkeinError(RuntimeError):
    """A command failed; the message is its error output."""


class NotFound(SkeinError):
    """Java 25 or Skein's own files are missing; the message states which, and where they were sought."""
