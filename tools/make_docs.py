#!/usr/bin/env python3
"""Builds the documentation site: tools/make_docs.py PROGRAM BUILD_DIRECTORY, in an environment with Sphinx.

The pages are the Markdown files of the repository, which read well where they are; here they are copied beside pages
that the program itself writes (case-file keys, commands, verification) and pages from the sources (C++ headers, Python
docstrings), and links between files become links between pages. docs/index.md is the front page, and its links, section
by section, are the navigation. Warnings are errors.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LINK = re.compile(r"(!?\[[^\]]*\])\(([^)\s#]+)(#[^)\s]*)?\)")
FENCE = re.compile(r"(^```.*?^```$)", re.M | re.S)
# Pages that are written here: file, the section of docs/index.md whose navigation they join.
GENERATED = {
    "reference/case_keys.md": "Reference",
    "reference/commands.md": "Reference",
    "reference/python.md": "Reference",
    "reference/headers.md": "Reference",
    "reference/verification.md": "Reference",
    "systems/gallery.md": "Systems of the thesis",
}


def tell(program, *arguments):
    return subprocess.run([program, *arguments], stdout=subprocess.PIPE, text=True, check=True,
                          env=dict(os.environ, NO_COLOR="1", COLUMNS="100")).stdout


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


# ---- pages the program writes ----
def case_keys(program):
    """Every key of the case file, asked from `tendril explain`, which reads the table that checks case files."""
    page = ["# Keys of the case file", "",
            f"Written by the program ({tell(program, '--version').strip()}) from the table that also checks case files and "
            "makes `tendril schema`. `tendril explain KEY` tells the same. With `units = \"si\"` a number is in the unit "
            "named, or a string with a unit. A key of a table is called `rod.diameter` on the command line and in Python.", ""]

    def children(path):
        lines = tell(program, "explain", *([path] if path else [])).splitlines()
        pattern = re.compile(r"  (" + (re.escape(path) + r"\." if path else "") + r"[a-z_]+)  +\S")
        return [found[1] for line in lines if (found := pattern.match(line))]

    def add(path, level):
        own, tables = [], []
        for key in children(path):
            (tables if children(key) else own).append(key)
        if own:
            page.extend(["| key | accepts | meaning |", "|---|---|---|"])
        prefix = len(path) + 1 if path else 0
        for key in own:
            first, *facts = tell(program, "explain", key).splitlines()[1:]
            fact = dict(line.strip().partition(": ")[::2] for line in facts)
            accepts = fact.pop("accepts", "")
            if "measures" in fact:
                accepts += "; " + fact.pop("measures").replace('with units = "si" in', "SI:")
            meaning = first.strip()
            if "required" in fact:
                fact.pop("required")
                meaning += ". **Required**"
            meaning += "".join(f". {name.capitalize()}: {what}" for name, what in fact.items())
            page.append(f"| `{key[prefix:]}` | {cell(accepts)} | {cell(meaning)} |")
        page.append("")
        for key in tables:
            lines = tell(program, "explain", key).splitlines()
            required = " **Required.**" if "  required" in lines else ""
            page.extend([f"{'#' * level} `[{key}]`", "", lines[1].strip() + required, ""])
            add(key, level + 1)

    add("", 2)
    return "\n".join(page)


def commands(program):
    whole = tell(program, "--help")
    listed = whole.split("Subcommands:\n")[1].split("\n\n")[0]
    examples = whole[whole.index("\nexamples:"):]
    page = ["# Commands of the program", "", "Written by the program: `tendril --help` and `tendril COMMAND --help`.", "",
            "```text", whole.strip(), "```"]
    for line in listed.splitlines():
        name = line.split()[0]
        own = tell(program, name, "--help").replace(examples, "").strip()
        page += ["", f"## {name}", "", "```text", own.partition("\nexamples:")[0].strip(), "```"]
    return "\n".join(page)


def verification(program):
    lines = tell(program, "verify").splitlines()
    row = re.compile(r"(.*?)((?:\s+[-+0-9.e]+){4})$")
    page = ["# Verification", "",
            "Written by `tendril verify`, when this site was built: what the program computes against closed forms, "
            "independent solvers and printed results. The command fails if a difference exceeds its tolerance.", ""]
    group = None
    for line in lines[1:]:
        found = row.match(line)
        if not found:
            if line.strip():
                page += ["", line.strip()]
            continue
        name, _, quantity = found[1].strip().partition(": ")
        computed, expected, difference, tolerance = found[2].split()
        if name != group:
            group = name
            page += ["", f"## {name[:1].upper()}{name[1:]}", "",
                     "| quantity | computed | expected | difference | tolerance |", "|---|---:|---:|---:|---:|"]
        page.append(f"| {cell(quantity)} | {computed} | {expected} | {difference} | {tolerance} |")
    return "\n".join(page)


# ---- pages from the sources ----
def headers():
    page = ["# C++ headers, room by room", "",
            "The opening words of every header of `tendril::tendril`, lowest room first; a room includes only rooms above "
            "it. Headers whose name ends in `_detail` are left out."]
    order = re.search(r"ROOMS = \[(.*?)\]", (ROOT / "tools/check_layers.py").read_text(), re.S)
    rooms = re.findall(r'"(\w+)"', order[1]) if order else sorted(p.name for p in (ROOT / "src/tendril").iterdir() if p.is_dir())
    for room in rooms:
        entries = []
        for header in sorted((ROOT / "src/tendril" / room).glob("*.hpp")):
            words = []
            for line in header.read_text().splitlines()[1:]:
                if not line.startswith("//"):
                    break
                words.append(line.lstrip("/ "))
            if words and not header.stem.endswith("_detail"):
                entries.append(f"| `{room}/{header.name}` | {cell(' '.join(words)).replace('<', '&lt;').replace('*', chr(92) + '*')} |")
        if entries:
            page += ["", f"## {room}", "", "| header | |", "|---|---|", *entries]
    return "\n".join(page)


def gallery():
    """The first picture of every system."""
    page = ["# Gallery", "", "A picture of each system of the thesis; its page has the problem, the equations and the numbers."]
    for path in sorted((ROOT / "docs/systems").glob("*.md")):
        text = path.read_text()
        if picture := re.search(r"!\[([^\]]*)\]\((images/[^)]+)\)", text):
            title = text.splitlines()[0].lstrip("# ")
            page += ["", f"## [{title}]({path.name})", "", f"![{title}]({picture[2]})"]
    return "\n".join(page)


PYTHON_PAGE = """# Python package

From the docstrings of the package; [how it is used](../python/README.md).

```{eval-rst}
.. automodule:: tendril
   :members:
   :undoc-members:
   :imported-members:

tendril.plot
------------
.. automodule:: tendril.plot
   :members:
   :undoc-members:
```
"""


# ---- pages of the repository ----
def site_path(path):
    """Where a file of the repository goes: docs/ is the root of the site."""
    return path.relative_to("docs") if path.parts[0] == "docs" else path


def rewrite(text, page, wanted):
    """Links of a page, relative to where the files go; what is no page and no file of ours becomes plain words."""

    def link(found):
        words, target, anchor = found[1], found[2], found[3] or ""
        if re.match(r"[a-z]+:", target):
            return found[0]
        path = pathlib.Path(os.path.normpath(page.parent / target))
        if not (ROOT / path).exists():
            raise SystemExit(f"make_docs: {page} links to {target}, which is not there")
        if not (ROOT / path).is_file():
            return words.lstrip("!")[1:-1]
        wanted.add(path)
        return f"{words}({os.path.relpath(site_path(path), site_path(page).parent)}{anchor})"

    parts = FENCE.split(text)
    return "".join(part if i % 2 else LINK.sub(link, part) for i, part in enumerate(parts))


def navigation(index, pages):
    """Hidden tables of contents, one for each section of the front page whose table links to pages. A page that it does not name
    follows its neighbours in the same folder."""
    sections, named = {}, set()
    for section in re.split(r"^## ", index, flags=re.M)[1:]:
        caption = section.split("\n", 1)[0]
        rows = "\n".join(line for line in section.splitlines() if line.startswith("|"))
        links = [str(site_path(pathlib.Path(os.path.normpath(f"docs/{target}")))) for _, target, _ in LINK.findall(rows)
                 if target.endswith(".md")]
        sections[caption] = [name for name in dict.fromkeys(links) if name not in named]
        named.update(links)
    for name in sorted({str(site_path(page)) for page in pages} - named - {"index.md"}):
        folder = os.path.dirname(name)
        for names in sections.values():
            if folder and folder in map(os.path.dirname, names):
                names.append(name)
                break
    tail = []
    for caption, names in sections.items():
        names += [name for name, place in GENERATED.items() if place == caption]
        if names:
            tail += ["", "```{toctree}", ":hidden:", f":caption: {caption}", "", *names, "```"]
    return "\n".join(tail)


def main(program, build):
    source = build / "docs-source"
    shutil.rmtree(source, ignore_errors=True)
    pages = [p.relative_to(ROOT) for place in ("docs", "examples") for p in (ROOT / place).rglob("*.md")]
    wanted = {p for p in pages if p.name != "template.md"} | {pathlib.Path("CHANGELOG.md")}
    done = set()
    while todo := sorted(wanted - done):
        for path in todo:
            done.add(path)
            goal = source / site_path(path)
            goal.parent.mkdir(parents=True, exist_ok=True)
            if path.suffix == ".md":
                goal.write_text(rewrite((ROOT / path).read_text(), path, wanted))
            else:
                shutil.copyfile(ROOT / path, goal)
    done_pages = {p for p in done if p.suffix == ".md"}
    written = {"reference/case_keys.md": case_keys(program), "reference/commands.md": commands(program),
               "reference/verification.md": verification(program), "reference/headers.md": headers(),
               "reference/python.md": PYTHON_PAGE, "systems/gallery.md": gallery()}
    assert set(written) == set(GENERATED)
    for name, text in written.items():
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        (source / name).write_text(text)
    with (source / "index.md").open("a") as index:
        index.write("\n" + navigation((ROOT / "docs/index.md").read_text(), done_pages) + "\n")
    return subprocess.run([sys.executable, "-m", "sphinx", "-c", ROOT / "docs", "-b", "html", "-W", "--keep-going", "-q",
                           "-j", "2", "-d", build / "docs-doctrees", source, build / "docs"], check=False).returncode


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()))
