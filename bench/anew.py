#!/usr/bin/env python3
"""Runs the commands behind the tables of docs/results*.md again, and says how long each took.

    python3 bench/anew.py FOLDER [--list] [--only PART]

Each command stands beside its table, in backticks. What it prints goes to FOLDER/NN.txt, what it writes to
FOLDER/NN; FOLDER/README.md lists all with their times. Nothing in docs changes: compare, and edit by hand. What
this machine cannot measure is listed with the reason. Needs a checkout that ./skein has built.
"""

from __future__ import annotations

import argparse
import glob
import os
import re
import shlex
import shutil
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
WRITES = ("fly", "search", "budget", "learn")  # take --out


def commands() -> list[tuple[str, str]]:
    """Page and command, in the order of the pages, each command once."""
    found: dict[str, str] = {}
    for page in ["docs/results.md", *sorted(glob.glob("docs/results/*.md", root_dir=ROOT))]:
        with open(os.path.join(ROOT, page), encoding="utf-8") as text:
            for command in re.findall(r"`(\./s(?:kein|btw) [^`]+)`|^(\./skein .+)$", text.read(), re.M):
                found.setdefault("".join(command), page)
    return [(page, command) for command, page in found.items()]


def missing(command: str, policy: str | None) -> str | None:
    """Why a command cannot be run here, if it cannot."""
    if "…" in command or re.search(r"\bNAME\b", command):
        return "a pattern, not a whole command"
    if re.search(r"--gpu|GpuRates", command) and not shutil.which("nvidia-smi"):
        return "needs a GPU of NVIDIA, which is not here"
    if " serve " in command:
        return "waits for other programs"
    if command == "./skein identify":
        return "needs a recording"
    if re.search(r"\bFILE\b", command) and policy is None:
        return "needs the policy of a search before it"
    return None


def run(command: str, folder: str, number: int, policy: str | None) -> tuple[float, int]:
    out = os.path.join(folder, f"{number:02}")
    whole = re.sub(r"\bDIR\b", shlex.quote(out), command)
    whole = re.sub(r"\bFILE\b", shlex.quote(policy or ""), whole)
    if command.startswith("./skein ") and command.split()[1] in WRITES and "--out" not in command:
        whole += f" --out {shlex.quote(out)}"
    start = time.monotonic()
    with open(out + ".txt", "w", encoding="utf-8") as said:
        said.write(f"$ {whole}\n")
        said.flush()
        status = subprocess.run(whole, shell=True, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=said, stderr=said)
    return time.monotonic() - start, status.returncode


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--list", action="store_true", help="says what would be run, and runs nothing")
    parser.add_argument("--only", default="", help="commands that contain this text alone")
    options = parser.parse_args()
    folder = os.path.abspath(options.folder)
    if not options.list:
        os.makedirs(folder, exist_ok=True)
    rows, failed, policy = [], 0, None
    for number, (page, command) in enumerate(commands(), 1):
        if options.only not in command:
            continue
        reason = missing(command, policy)
        if reason or options.list:
            told = f"not measured: {reason}" if reason else "would be run"
        else:
            print(f"{number:02}  {command}", flush=True)
            took, status = run(command, folder, number, policy)
            policy = next(iter(glob.glob(os.path.join(folder, f"{number:02}", "**/policy.conf"), recursive=True)), policy)
            failed += status != 0
            told = f"{took:.0f} s" + ("" if status == 0 else f", failed with status {status}")
        print(f"{number:02}  {told:<40}  {command}", flush=True)
        rows.append(f"| {number:02} | {page} | `{command}` | {told} |")
    if options.list:
        return 0
    with open(os.path.join(folder, "README.md"), "w", encoding="utf-8") as table:
        table.write("| | page | command | took |\n|---|---|---|---|\n" + "\n".join(rows) + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
