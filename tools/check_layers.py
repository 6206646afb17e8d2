#!/usr/bin/env python3
"""Refuse an include that points upwards, or a library outside the rooms it belongs to.

The rooms of src/tendril are listed lowest first; a room may include itself and the rooms below it. apps/ and tests/
may include every room. Headers directly in src/tendril (version.hpp) lie below all rooms.
"""
import argparse
import pathlib
import re
import sys
import tempfile

ROOMS = ["numerics", "collocation", "geometry", "rod", "formulation", "closed_form", "segmentation", "continuation", "drawing",
         "reproduce", "report", "io"]
# Libraries that only some places may know: include prefix -> rooms (or top directories) that may use it.
LIBRARIES = {
    "toml++/": {"io", "apps", "tests"},
    "nlohmann/": {"io", "apps", "tests"},
    "fmt/": {"io", "apps", "tests"},
    "pugixml.hpp": {"io"},
    "zlib.h": {"io", "tests"},
    "CLI/": {"apps"},
    "boost/": {"tests"},
    "gtest/": {"tests"},
    "gmock/": {"tests"},
    "benchmark/": {"bench"},
    "nanobind/": {"python"},
}
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')
SUFFIXES = {".hpp", ".cpp", ".h", ".cc", ".ipp"}


def place_of(path, root):
    """Room of a source, or its top directory (apps, tests, bench), or '' for headers directly in src/tendril."""
    parts = path.relative_to(root).parts
    if parts[:2] == ("src", "tendril"):
        return parts[2] if len(parts) > 3 else ""
    return parts[0]


def target_room(include, quoted, path, root):
    """Room that an include leads to; None for anything that is not ours."""
    if include.startswith("tendril/"):
        parts = include.split("/")
        return parts[1] if len(parts) > 2 else ""
    if quoted:
        target = (path.parent / include).resolve()
        if target.is_file() and (root / "src" / "tendril").resolve() in target.parents:
            return place_of(target, root.resolve())
    return None


def check(root):
    problems = []
    files = [p for top in ("src", "apps", "python", "tests", "bench") for p in sorted((root / top).rglob("*")) if p.suffix in SUFFIXES]
    for path in files:
        place = place_of(path, root)
        if place and place not in ROOMS and path.relative_to(root).parts[0] == "src":
            problems.append(f"{path.relative_to(root)}: '{place}' is not a room")
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            include = match.group(2)
            where = f"{path.relative_to(root)}:{number}"
            for prefix, allowed in LIBRARIES.items():
                if include.startswith(prefix) and place not in allowed:
                    problems.append(f"{where}: <{include}> is not for {place or 'src/tendril'}")
            target = target_room(include, match.group(1) == '"', path, root)
            if target is None or place not in ROOMS + [""]:
                continue
            if target and target not in ROOMS:
                problems.append(f"{where}: '{target}' is not a room")
            elif target and (place == "" or ROOMS.index(target) > ROOMS.index(place)):
                problems.append(f"{where}: {place or 'src/tendril'} may not include {target}, which lies above it")
    return len(files), problems


def self_test():
    """The check must accept a sound tree and find each kind of fault planted in it."""
    faults = {
        "src/tendril/geometry/a.hpp": '#include "tendril/rod/rod.hpp"',
        "src/tendril/numerics/b.cpp": '#include "../io/case.hpp"',
        "src/tendril/rod/c.cpp": "#include <toml++/toml.h>",
        "src/tendril/version.cpp": '#  include "tendril/numerics/dual.hpp"',
        "src/tendril/attic/d.cpp": "int x;",
        "src/tendril/io/e.cpp": '#include "tendril/attic/d.hpp"',
        "apps/tendril/f.cpp": "#include <boost/math/special_functions.hpp>",
    }
    sound = {
        "src/tendril/io/case.hpp": '#include <nlohmann/json.hpp>\n#include "tendril/continuation/study.hpp"',
        "src/tendril/rod/rod.hpp": '#include "tendril/numerics/dual.hpp"\n#include <Eigen/Core>',
        "src/tendril/rod/same.cpp": '#include "rod.hpp"',
        "src/tendril/numerics/dual.hpp": "// #include \"tendril/io/case.hpp\"\n#include <cmath>",
        "tests/unit/rod_a.cpp": '#include <gtest/gtest.h>\n#include "tendril/io/case.hpp"',
    }

    def run(tree):
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            for path, text in tree.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text + "\n", encoding="utf-8")
            return check(root)[1]

    failed = [f"sound tree refused: {p}" for p in run(sound)]
    for path, text in faults.items():
        found = run({**sound, path: text})
        if len(found) != 1 or not found[0].startswith(path):
            failed.append(f"planted fault in {path} gave {found}")
    for line in failed:
        print(line, file=sys.stderr)
    print(f"check_layers: {1 + len(faults) - len(failed)} passed, {len(failed)} failed (self-test)")
    return 1 if failed else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--self-test", action="store_true", help="check the checker")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    arguments = parser.parse_args()
    if arguments.self_test:
        return self_test()
    count, problems = check(arguments.root)
    for line in problems:
        print(line, file=sys.stderr)
    print(f"check_layers: {count} files, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
