"""Exceptions of this package."""

from __future__ import annotations

import importlib
from typing import Any


class SkeinError(RuntimeError):
    """A command failed; the message is its error output."""


class NotFound(SkeinError):
    """Java 25 or Skein's own files are missing; the message states which, and where they were sought."""


class NotInstalled(NotFound, ImportError):
    """A Python package is missing; the message states how to install it."""


def needed(module: str, extra: str) -> Any:
    """Imports a module of another package, which an extra of this one installs."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module:
            raise
    raise NotInstalled(f"{module} is not installed; pip install 'skein-uav[{extra}]' installs it")
