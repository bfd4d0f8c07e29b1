#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The pages of docs as a site: folders of files that ask no other site for anything.

    website.py FOLDER LIBRARY     writes the site to FOLDER/site, from pages that it writes to FOLDER/pages; then checks it

The pages are those of docs, README and its neighbours, the interface in C as docs/api.json and the headers have it, and
the package of Python as `help()` tells it (LIBRARY is what it loads). MkDocs makes HTML of them. Fails when a page is in
no group below, when a link leads nowhere, and when something would be loaded from elsewhere.
"""
import html.parser
import os
import re
import shutil
import sys
from pathlib import Path
from urllib.parse import unquote

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools/website"))
import c_reference  # noqa: E402
import python_reference  # noqa: E402

GROUPS = {
    "Learn": "tutorial cookbook python_notebook gallery/README install",
    "Use": "viewer page python files frames furniture profile sample scale cluster gpu",
    "Concepts": "conventions scene framing section shading layers levels sharp features colors photos acquisition texture warp gaussians "
                "volume volume_files gradients",
    "Mathematics": "math notation homogeneous kernels papers/README papers/surface_splatting papers/perspective_accurate_splatting "
                   "papers/hybrid_forward_resampling papers/homogeneous_coordinates",
    "Measured": "performance quality machines testing",
    "Project": "architecture versions CONTRIBUTING CODE_OF_CONDUCT SECURITY CHANGELOG",
}
ABOVE = {"README.md": "index.md", "CONTRIBUTING.md": "CONTRIBUTING.md", "CODE_OF_CONDUCT.md": "CODE_OF_CONDUCT.md",
         "SECURITY.md": "SECURITY.md", "CHANGELOG.md": "CHANGELOG.md"}
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")


def homes():
    """Where each page of the repository is on the site."""
    pages = {name: home for name, home in ABOVE.items()}
    pages.update({str(path.relative_to(ROOT)): str(path.relative_to(ROOT / "docs")) for path in (ROOT / "docs").rglob("*.md")})
    return pages


def rewritten(name, text, pages, files):
    """A page as MkDocs reads it; `files` takes what it shows and links to."""
    home = Path(pages[name])

    def link(match):
        mark, words, target = match.groups()
        path, _, anchor = target.partition("#")
        if re.match(r"https?:|mailto:", target) or not path:
            return match.group()
        inside = os.path.normpath(Path(name).parent / path)
        there = pages.get(inside)
        if not there and inside.startswith("docs/") and (ROOT / inside).is_file():
            there = inside.removeprefix("docs/")
            files.add(there)
        if not there:
            return words  # sources are not on the site
        return f"{mark}[{words}]({os.path.relpath(there, home.parent)}{'#' + anchor if anchor else ''})"

    out, fenced = [], False
    for line in text.split("\n"):
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced:
            starts = re.match(r"(?:[-*] |\d+\. |\|)", line)
            before = out[-1] if out else ""
            if starts and before.strip() and not re.match(r"\s*(?:[-*] |\d+\. |\|| )", before) and not in_list(out):
                out.append("")  # these may follow a paragraph, here not in MkDocs
            if line.startswith("|"):
                line = re.sub(r"`[^`]*`", lambda code: code.group().replace("\\|", "|"), line)
            line = re.sub(r"(?<!\[)`(docs/\w+\.md)`", lambda page: f"[{page.group(1)}]({os.path.relpath(page.group(1), Path(name).parent)})", line)
        out.append(line)
    return LINK.sub(link, "\n".join(out))


def in_list(lines):
    """Whether the paragraph that ends the lines is an item of a list."""
    for line in reversed(lines):
        if not line.strip():
            return False
        if re.match(r"\s*(?:[-*] |\d+\. )", line):
            return True
    return False


def write_pages(folder):
    """Writes the pages; returns the tree of their titles."""
    pages, files = homes(), set()
    for name, home in pages.items():
        target = folder / home
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(rewritten(name, (ROOT / name).read_text(), pages, files))
    for file in files:
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / "docs" / file, folder / file)
    headers, missing = c_reference.write(ROOT, folder / "c")
    if missing:
        sys.exit(f"on no page of the interface in C: {', '.join(missing)}")
    sys.path.insert(0, str(ROOT / "python"))
    import ewa
    classes = python_reference.write(ewa, folder / "python_api")
    groups = {group: [f"{page}.md" for page in names.split()] for group, names in GROUPS.items()}
    told = {page for group in groups.values() for page in group} | {"index.md", "cli.md"}
    if lost := sorted(set(pages.values()) ^ told):
        sys.exit(f"pages and groups of tools/website.py differ: {', '.join(lost)}")
    reference = {"Program": "cli.md",
                 "C": ["c/index.md"] + [{f"{name}.h": f"c/{name}.md"} for name in headers],
                 "Python": ["python_api/index.md", "python_api/functions.md"] + [f"python_api/{name}.md" for name in classes]
                 + ["python_api/exceptions.md"]}
    tree = [{"ewa": "index.md"}] + [{group: names} for group, names in groups.items()]
    tree.insert(4, {"Reference": [{name: part} for name, part in reference.items()]})
    return tree


def build(pages, site, tree):
    from mkdocs.commands.build import build as make
    from mkdocs.config import load_config

    (pages.parent / "mkdocs.yml").write_text("site_name: ewa\n")

    def slug(words, separator):
        """As the pages' links have it (test `names`)."""
        return re.sub(r"[^\w\- ]", "", words.strip().lower()).replace(" ", separator)

    config = load_config(
        str(pages.parent / "mkdocs.yml"), docs_dir=str(pages), site_dir=str(site), nav=tree, strict=True, use_directory_urls=False,
        site_description="Draws point clouds as continuous, antialiased surfaces",
        theme={"name": "material", "font": False, "features": ["navigation.tabs", "navigation.indexes", "navigation.top"]},
        markdown_extensions=["sane_lists", "attr_list", "pymdownx.highlight", "pymdownx.superfences",
                             {"toc": {"slugify": slug, "toc_depth": 3}}])
    make(config)


class Page(html.parser.HTMLParser):
    """What a page of the site has, loads and links to."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.loads = set(), set(), set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        has = dict(attributes)
        self.ids |= {has[name] for name in ("id", "name") if has.get(name)}
        if tag in ("a", "area") and has.get("href"):
            self.links.add(has["href"])
        elif tag == "link" and has.get("rel") not in ("canonical",):
            self.loads.add(has.get("href", ""))
        elif has.get("src"):
            self.loads.add(has["src"])


def check(site):
    """Lists links that lead nowhere and what is loaded from elsewhere."""
    pages = {path: Page(path.read_text()) for path in site.rglob("*.html")}
    problems = []
    for path, page in pages.items():
        here = path.relative_to(site)
        problems += [f"{here} loads {there}" for there in page.loads if re.match(r"(?:[a-z]+:)?//", there)]
        for target in page.links | page.loads:
            if re.match(r"(?:[a-z]+:|//)", target) or here.name == "404.html":
                continue
            name, _, anchor = unquote(target).partition("#")
            there = (path.parent / name.split("?")[0]).resolve() if name else path
            there = there / "index.html" if there.is_dir() else there
            if not there.is_file():
                problems.append(f"{here}: {target} is not there")
            elif anchor and there in pages and anchor not in pages[there].ids:
                problems.append(f"{here}: {target}: no such heading")
    for path in site.rglob("*.css"):
        problems += [f"{path.relative_to(site)} loads {there}" for there in re.findall(r"(?:url\(|@import )[\"']?(https?:[^\"')]*)", path.read_text())]
    return len(pages), sorted(problems)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    folder = Path(sys.argv[1]).resolve()
    os.environ["EWA_LIBRARY"] = str(Path(sys.argv[2]).resolve())
    try:
        import mkdocs  # noqa: F401
        import numpy  # noqa: F401
    except ImportError as problem:
        system = "/usr/bin/python3"  # which has what Debian installs, where another is first in PATH
        if os.path.exists(system) and os.path.realpath(sys.executable) != os.path.realpath(system):
            os.execv(system, [system, *sys.argv])
        print(f"skipped: {problem}")
        sys.exit(77)
    shutil.rmtree(folder, ignore_errors=True)
    tree = write_pages(folder / "pages")
    build(folder / "pages", folder / "site", tree)
    count, problems = check(folder / "site")
    print("\n".join(problems + [f"{count} pages, {len(problems)} problems"]))
    sys.exit(bool(problems))


if __name__ == "__main__":
    main()
