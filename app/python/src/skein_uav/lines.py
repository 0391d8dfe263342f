"""The lines of a scenario's file, and the places in Python that they are from."""

from __future__ import annotations

import re
from typing import Any

from .symbols import Condition, Graph, Number
from .untraceable import Untraceable

_MOST_NODES = 120_000


class Lines:
    """Collects the lines of a file that contain nodes of a graph.

    Attributes
    ----------
    at : str
        The place of the lines that are added next, for messages: ``patrol.py:31: the policy of Scout``.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.at = ""
        self._lines: list[tuple[str, tuple[Any, ...]]] = []

    def add(self, *words: Any) -> None:
        self._lines.append((self.at, words))

    def file(self, head: list[str]) -> tuple[str, dict[int, str]]:
        """The text after these first lines, and the places of its lines, by their numbers from 1 on.

        A node follows its arguments. Its place is that of the first line that needs it.
        """
        owners: dict[int, str] = {}
        for at, words in self._lines:
            left = [word.node for word in words if isinstance(word, (Number, Condition))]
            while left:
                node = left.pop()
                if node not in owners:
                    owners[node] = at
                    left.extend(self.graph.lines[node][1])
        if len(owners) > _MOST_NODES:
            raise Untraceable(
                f"expected at most {_MOST_NODES} operations in all policies and measures, got {len(owners)}; "
                "write fewer vehicles, or shorter policies"
            )
        places = {node: place for place, node in enumerate(sorted(owners))}
        lines = [("", line) for line in head]
        for node, place in places.items():
            op, args, text = self.graph.lines[node]
            words = [str(place), op, *(str(places[one]) for one in args), *([text] if text else [])]
            lines.append((owners[node], " ".join(words)))
        for at, parts in self._lines:
            words = [str(places[one.node]) if isinstance(one, (Number, Condition)) else str(one) for one in parts]
            lines.append((at, " ".join(words)))
        text = "".join(line + "\n" for _, line in lines)
        return text, {number: at for number, (at, _) in enumerate(lines, 1) if at}


def quoted(text: str) -> str:
    """A text as one word of a line."""
    plain = " ".join(str(text).split())
    if re.fullmatch(r"[A-Za-z][\w-]*", plain):
        return plain
    return '"' + plain.replace("\\", "\\\\").replace('"', '\\"') + '"'
