"""`tendril report` and `run --report` from outside: the page, what it refuses, and a build without the page. What the
page shows is tested in a browser (tests/web)."""

import json
import pathlib

from _tendril import CASE, expect, run

pathlib.Path("case.toml").write_text(CASE)
expect(run("run", "case.toml", "--json", "r.json", "--fields", "-q"), 0)

tube = json.loads(pathlib.Path("r.json").read_text())["tube"]
assert tube["side"] == "inside" and tube["rod_radius"] is None and len({len(v) for v in tube.values() if isinstance(v, list)}) == 1
assert tube["S"][0] == 0 and tube["S"][-1] == 1 and set(tube["clearance"]) == {0.05} and set(tube["curvature"]) == {0}

expect(run("report"), 2, stderr=["RESULT"])
expect(run("report", "r.json"), 2, stderr=["--output"])
page = run("report", "r.json", "-o", "page.html")
if page.returncode == 2:  # a build without Node
    expect(page, 2, stderr=["built without the report page", "TENDRIL_REPORT_HTML"])
    expect(run("run", "case.toml", "--report", "page.html"), 2, stderr=["built without the report page"])
    assert not pathlib.Path("page.html").exists()
else:
    expect(page, 0, stderr=["wrote page.html", "MB"])
    text = pathlib.Path("page.html").read_text()
    assert text.startswith("<!doctype html>") and "TENDRIL_RESULT" not in text and len(text) < 5e6
    assert text.count('id="tendril-result">{"page":') == 1
    assert expect(run("report", "r.json", "-o", "-"), 0).stdout == text
    expect(run("run", "case.toml", "--report", "other.html"), 0, stdout=["converged"], stderr=["wrote other.html"])
    assert '"fields":{"S":[0' in pathlib.Path("other.html").read_text()

    pathlib.Path("not.json").write_text('{"steps": 1}')
    expect(run("report", "not.json", "-o", "x.html"), 3, stderr=["not a result file", "tendril run --json"])
    pathlib.Path("broken.json").write_text('{"result_schema": 1, "steps": [}')
    expect(run("report", "broken.json", "-o", "x.html"), 3, stderr=["broken.json:1"])
    pathlib.Path("odd.json").write_text('{"result_schema": 1, "steps": [1]}')
    expect(run("report", "odd.json", "-o", "x.html"), 3, stderr=["odd.json"])
    expect(run("report", "none.json", "-o", "x.html"), 6, stderr=["none.json"])
    expect(run("report", "r.json", "-o", "none/x.html"), 6, stderr=["none/x.html"])
    assert not pathlib.Path("x.html").exists()
