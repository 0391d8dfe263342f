"""Draws what learn.py wrote: python examples/delay/draw.py [FOLDER] [PICTURE].

Lines are means over seeds, each point of a tenth of the steps."""

import csv
import re
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib.pyplot as plt

TOLD = ("no_delay", "observation", "observation-age", "observation-8_pending_actions", "observation-age-8_pending_actions")


def curves(folder):
    """Of each environment and of what was told, the runs: lists of (step, return)."""
    found = defaultdict(lambda: defaultdict(list))
    for path in sorted(folder.glob("*.csv")):
        name, told = re.fullmatch(r"(\w+-v\d)-(.+)-\d+", path.stem).groups()
        with open(path, newline="") as file:
            found[name][told].append([(int(row["step"]), float(row["return"])) for row in csv.DictReader(file)])
    return found


def tenths(runs):
    last = max(step for run in runs for step, _ in run)
    for tenth in range(1, 11):
        values = [value for run in runs for step, value in run if (tenth - 1) * last < step * 10 <= tenth * last]
        if values:
            yield tenth * last / 10, sum(values) / len(values)


def main(folder, picture):
    found = curves(folder)
    figure, panels = plt.subplots(1, len(found), figsize=(4.5 * len(found), 5), squeeze=False)
    for panel, (name, told) in zip(panels[0], found.items()):
        for place, what in enumerate(TOLD):
            if what in told:
                label = what.replace("-", ", ").replace("_", " ")
                panel.plot(*zip(*tenths(told[what])), color=f"C{place}", label=f"{label} ({len(told[what])})")
        panel.set(title=name, xlabel="steps", ylabel="return")
        panel.locator_params(axis="x", nbins=5)
        # Seeds differ from panel to panel.
        panel.legend(title="told (seeds)", fontsize="small", loc="upper center", bbox_to_anchor=(0.5, -0.2))
    figure.tight_layout()
    figure.savefig(picture)


if __name__ == "__main__":
    main(Path(*sys.argv[1:2] or ["curves"]), *sys.argv[2:3] or ["curves.svg"])
