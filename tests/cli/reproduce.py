"""The systems of the thesis from outside: the list, one computed with its files, typos, broken targets, Ctrl-C."""

import csv
import pathlib
import re
import shutil
import signal
import subprocess
import time
import xml.etree.ElementTree as ElementTree

from _tendril import PROGRAM, expect, run

listed = expect(run("reproduce"), 0, stdout=["name", "thesis", "title", "reproduce all -o DIR"]).stdout
names = [line.split()[0] for line in listed.splitlines()[1:] if line and not line.startswith("`")]

expect(run("reproduce", "al"), 2, stderr=["there is no system `al`", "did you mean `all`?"])
expect(run("reproduce", "-o", "none"), 2, stderr=["which system is written to `none`?", "NAME"])
expect(run("reproduce", "x", "--outptu", "y"), 2, stderr=["did you mean `--output`?"])

for name in names:
    wrong = name[:2] + name[3:]
    expect(run("reproduce", wrong), 2, stderr=[f"did you mean `{name}`?"])

# A closed form of all and so the quickest.
if "point_contact" in names or "helical_conduit" in names:
    name = "point_contact" if "point_contact" in names else "helical_conduit"
    out = pathlib.Path("one")
    shutil.rmtree(out, ignore_errors=True)
    result = expect(run("reproduce", name, "-o", out), 0, stdout=["quantity", "computed", "expected", "rows hold"])
    assert "\r" not in result.stderr, result.stderr  # no animation off a terminal
    assert not list(out.glob("*.part*"))
    with open(out / "table.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert rows and all(row["holds"] == "yes" for row in rows), rows
    for row in rows:
        assert abs(float(row["computed"]) - float(row["expected"])) <= float(row["tolerance"]), row
    pictures = sorted(out.glob("*.svg"))
    page = (out / "index.html").read_text(encoding="utf-8")
    assert pictures
    for picture in pictures:
        assert ElementTree.parse(picture).getroot().tag.endswith("svg")
        assert picture.name in page
    assert len(re.findall("<svg ", page)) == len(pictures)
    assert not re.search(r'(src|href)="(https?:)?//', page), "the page must open offline"
    for file in out.glob("*.csv"):
        with open(file, newline="", encoding="utf-8") as stream:
            table = list(csv.reader(stream))
        assert len(table) > 1 and len({len(row) for row in table}) == 1, file
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    expect(run("reproduce", name, "-o", out, "--quiet"), 0)
    assert before == {path.name: path.read_bytes() for path in out.iterdir()}, "two runs differ"

    pathlib.Path("file").write_text("", encoding="utf-8")
    expect(run("reproduce", name, "-o", "file/x"), 6, stderr=["file/x"])

    with subprocess.Popen([PROGRAM, "reproduce", "all", "-o", "stopped"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True) as process:
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=120)
        assert process.returncode == 130, process.returncode
    assert "not computed" in pathlib.Path("stopped/index.html").read_text(encoding="utf-8")
