"""Makes Scaladoc's pages readable without a network and without a server: offline.py PAGES NODE_MODULES."""

import re
import shutil
import sys
from pathlib import Path

pages, packages = map(Path, sys.argv[1:])
scripts = pages / "scripts"

# Pages name these by addresses; what runs snippets elsewhere is left out.
for package in ("jquery", "d3", "graphlib-dot", "dagre-d3"):
    shutil.copy(packages / package / "dist" / f"{package}.min.js", scripts)
    shutil.copy(next((packages / package).glob("LICENSE*")), scripts / f"{package}.LICENSE")
names = {"jquery-3.5.1.min.js": "jquery.min.js", "d3.v6.min.js": "d3.min.js", "embedded.js": None}
script = re.compile(r'<script type="text/javascript" src="https://[^"]*/([^"/]+)" defer="true"></script>')


def here(root, file):
    name = names.get(file, file)
    return f'<script type="text/javascript" src="{root}scripts/{name}" defer="true"></script>' if name else ""


for page in pages.rglob("*.html"):
    text = page.read_text()
    root = re.search(r'data-pathToRoot="([^"]*)"', text)
    page.write_text(script.sub(lambda found: here(root.group(1), found.group(1)), text) if root else text)

# From a disk, a browser runs scripts, but fetches no menu and starts no worker. The worker searches by signature alone;
# the search by name waits for it to be made.
code = (scripts / "ux.js").read_text()
fetched = "fetch(path).then(r => r.json())"
if fetched not in code:
    sys.exit(f"scripts/ux.js of Scaladoc has no {fetched}")
menu = (pages / "dynamicSideMenu.json").read_text()
silent = 'if (location.protocol === "file:") window.Worker = class extends EventTarget { postMessage() {} };'
code = code.replace(fetched, "Promise.resolve(sideMenu)")
(scripts / "ux.js").write_text(f"{silent}\nconst sideMenu = {menu};\n{code}")
