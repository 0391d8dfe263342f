"""What MkDocs does not know of this repository: how its pages are ordered, and what lies beside them."""

import posixpath
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
LINK = re.compile(r"(\]\()([^)\s#]+)(#[^)\s]*)?(?=\))")


def on_config(config):
    """The order of the pages is that of the tables in docs/README.md."""
    introduction, *sections = (ROOT / "docs/README.md").read_text().split("\n## ")
    seen = set()
    pages = ["docs/README.md", *new_pages(introduction, seen)]
    for section in sections:
        title, text = section.split("\n", 1)
        if found := new_pages(text, seen):
            pages.append({title: found})
    nav = [{"Skein": "README.md"}, {"Documentation": pages}]
    nav += [{"Architecture": "ARCHITECTURE.md"}]
    config.nav = [*nav, {"API": [{"Scala": "api/scala/index.html"}, {"Python": "api/python.md"}]}]


def new_pages(text, seen):
    """The pages of the tree that docs/README.md has a link to in `text`, and had none to before."""
    targets = [to for _, to, heading in LINK.findall(text) if to.endswith(".md") and not heading and ":" not in to]
    paths = [posixpath.normpath(f"docs/{to}") for to in dict.fromkeys(targets)]
    found = [path for path in paths if path not in seen]
    seen.update(found)
    return found


def on_page_markdown(markdown, page, config, files):
    """Links to the published site become links within this one, and links to sources lead to where those are shown."""
    folder = posixpath.dirname(page.file.src_uri)

    def moved(match):
        opening, target, anchor = match.group(1), match.group(2), match.group(3) or ""
        if target.startswith(config.site_url):
            path = target.removeprefix(config.site_url)
            if not files.get_file_from_path(path):
                path = path.removesuffix(".html") + ".md"
            target = posixpath.relpath(path, folder or ".")
        else:
            path = posixpath.normpath(posixpath.join(folder, target))
            if not files.get_file_from_path(path) and (ROOT / path).exists():
                target = config.extra["sources"] + path
        return opening + target + anchor

    return LINK.sub(moved, markdown)
