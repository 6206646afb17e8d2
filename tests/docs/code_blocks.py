"""Runs the code of the README and of every page of docs, examples and python, so that none of it goes stale.

Fenced blocks of a page run in order in one scratch directory with the program on PATH and the examples beside them:
`sh` with bash -e (lines that begin with make are left out: they have checks of their own), `toml` through `tendril
check`, `python` all of a page together in the interpreter TENDRIL_PYTHON, `cpp` compiled with the flags of pkg-config
from TENDRIL_PKG_CONFIG; the last two only where these are set. `text` is not code. A comment on the line
before a block says more:

    <!-- file: NAME -->    the block is written to NAME first
    <!-- prints -->        every line of this text block is among what the code before it printed, numbers to 1e-3
    <!-- not run: WHY -->  the block stays out

Arguments are pages; without any, all of them. --self-test proves that wrong blocks are found.
"""

import math
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path(os.environ["TENDRIL"]).resolve()
SOURCE = pathlib.Path(os.environ["TENDRIL_SOURCE_DIR"]).resolve()
PYTHON = os.environ.get("TENDRIL_PYTHON")
PKG_CONFIG = os.environ.get("TENDRIL_PKG_CONFIG")
BLOCK = re.compile(r"^(?:<!-- (?P<mark>[^\n]*?) -->\n)?```(?P<language>[^\n]*)\n(?P<text>.*?)^```$", re.M | re.S)
INDENTED = re.compile(r"^ {4}(?:tendril |build/|tools/|pip |cmake |python3? ).*$", re.M)


class Wrong(Exception):
    pass


def call(command, directory, **more):
    environment = dict(os.environ, PATH=f"{PROGRAM.parent}{os.pathsep}{os.environ['PATH']}", MPLBACKEND="agg",
                       NO_COLOR="1")
    done = subprocess.run(command, cwd=directory, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=600, check=False, **more)
    if done.returncode != 0:
        raise Wrong(f"{shlex.join(map(str, command))[:200]}: exit {done.returncode}\n{done.stdout}")
    return done.stdout


def cpp(text, directory):
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "tendril"], text=True, check=True,
                           env=dict(os.environ, PKG_CONFIG_PATH=PKG_CONFIG), stdout=subprocess.PIPE).stdout.split()
    (directory / "block.cpp").write_text(text)
    call(["g++", "-std=c++20", "-O1", "block.cpp", "-o", "block", *flags], directory)
    output = call(["./block"], directory)
    if not output.strip():
        raise Wrong("the program prints nothing")
    return output


def same(told, line):
    """Words equal, numbers to a part in a thousand: pages need not change when the last digits do."""
    told, line = told.split(), line.split()

    def equal(a, b):
        try:
            return math.isclose(float(a), float(b), rel_tol=1e-3)
        except ValueError:
            return a == b

    return len(told) == len(line) and all(map(equal, told, line))


def must_be_printed(body, printed):
    lost = [line for line in body.splitlines() if not any(same(told, line) for told in printed.splitlines())]
    if lost:
        raise Wrong("not printed by the block before:\n" + "\n".join(lost) + "\nbut:\n" + printed)


def scratch(directory):
    """What a reader has around him in a fresh clone, without the chance to change it."""
    (directory / "build/release/bin").mkdir(parents=True)
    (directory / "build/release/bin/tendril").symlink_to(PROGRAM)
    (directory / "docs/images").mkdir(parents=True)
    for name in ("examples", "tools", "python"):
        (directory / name).symlink_to(SOURCE / name)


def run_page(text, directory):
    """Number of blocks that ran."""
    ran, printed, script = 0, "", []
    rest = BLOCK.sub("", text)
    if match := INDENTED.search(rest) or re.search(r"^.*```.*$", rest, re.M):
        raise Wrong(f"code that is not in a fenced block at the margin: {match[0].strip()}")
    for block in BLOCK.finditer(text):
        mark, language, body = block["mark"] or "", block["language"], block["text"]
        where = f"block at line {text.count(chr(10), 0, block.start('language')) + 1}"
        if mark.startswith("not run: "):
            continue
        if mark.startswith("file: "):
            (directory / mark[6:]).write_text(body)
        try:
            if language == "sh":
                lines = [line for line in body.splitlines() if not line.startswith("make ")]
                printed = call(["bash", "-e", "-c", "\n".join(lines)], directory)
            elif language == "toml":
                name = mark[6:] if mark.startswith("file: ") else "block.toml"
                (directory / name).write_text(body)
                printed = call([PROGRAM, "check", name], directory)
            elif language == "python" and PYTHON:
                script.append(body)
                printed = call([PYTHON, "-c", "\n".join(script)], directory)
            elif language == "cpp" and PKG_CONFIG:
                printed = cpp(body, directory)
            elif language in ("python", "cpp"):
                printed = None  # not run here, nothing to compare with
                continue
            elif language == "text":
                if mark == "prints" and printed is not None:
                    must_be_printed(body, printed)
                continue
            else:
                raise Wrong(f"language {language!r}: name one of sh, toml, python, cpp, text")
        except Wrong as wrong:
            if "built without the report page" in str(wrong):  # a build without Node; what follows may need the page
                return ran
            raise Wrong(f"{where}: {wrong}") from None
        ran += 1
    return ran


def run_text(text):
    with tempfile.TemporaryDirectory() as name:
        scratch(pathlib.Path(name))
        return run_page(text, pathlib.Path(name))


def self_test():
    good = "<!-- file: a.txt -->\n```text\nseen\n```\n```sh\ncat a.txt\nmake nothing\n```\n<!-- prints -->\n```text\n seen\n```\n"
    assert run_text(good) == 1
    assert run_text("<!-- not run: no such file -->\n```sh\nfalse\n```\n") == 0
    wrong = ["```sh\nfalse\ntrue\n```\n", "```toml\nschema = 2\n```\n", "```\nls\n```\n", "text\n\n    tendril verify\n",
             "1. item\n\n   ```sh\n   ls\n   ```\n",
             good.replace(" seen", " unseen")]
    for text in wrong:
        try:
            run_text(text)
        except Wrong:
            continue
        raise AssertionError(f"not found to be wrong:\n{text}")


def pages():
    found = [SOURCE / "README.md", SOURCE / "python/README.md"]
    for place in ("docs", "examples"):
        found += sorted((SOURCE / place).rglob("*.md"))
    return found


self_test()
if sys.argv[1:] == ["--self-test"]:
    sys.exit()
failed = False
for page in [pathlib.Path(name).resolve() for name in sys.argv[1:]] or pages():
    try:
        count = run_text(page.read_text())
        if count:
            print(f"{page.relative_to(SOURCE)}: {count} blocks")
    except Wrong as wrong:
        failed = True
        print(f"{page.relative_to(SOURCE)}: {wrong}", file=sys.stderr)
sys.exit(failed)
