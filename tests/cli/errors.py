"""Wrong cases: exit code 3 with file, line, column, line and caret; files that cannot be read or written: 6."""

import pathlib

from _tendril import CASE, expect, run

pathlib.Path("good.toml").write_text(CASE)
expect(run("check", "good.toml"), 0, stdout=["good.toml: valid", "EI 1"])

bad = CASE.replace("bending_stiffness = 1.0", "bending_stiffness = -1.0")
bad = bad.replace("clearance", "clearence").replace('"straight"', '"strait"')
pathlib.Path("bad.toml").write_text(bad)
for command in ("check", "run"):
    result = expect(run(command, "bad.toml"), 3, stderr=[
        "bad.toml:5:21: error: `rod.bending_stiffness` is out of bounds\n"
        "    5 | bending_stiffness = -1.0\n"
        "      |                     ^~~~",
        "bad.toml:9:1: error: unknown key `tube.clearence`", "did you mean `clearance`?",
        "bad.toml:11:8: error:", 'did you mean "straight"?', "4 errors"])
    assert result.stdout == "", result.stdout
    assert "\033" not in result.stderr

pathlib.Path("empty.toml").write_text("")
expect(run("check", "empty.toml"), 3, stderr=["empty.toml:1:1: error: the case file is empty"])
pathlib.Path("broken.toml").write_text("schema = 1\n[rod\n")
expect(run("check", "broken.toml"), 3, stderr=["broken.toml:2:"])
pathlib.Path("broken.json").write_text('{"schema": 1,}')
expect(run("check", "broken.json"), 3, stderr=["broken.json:1:14: error: JSON syntax"])
expect(run("check", "good.toml", "--set", "end.axial_forse=1"), 3,
       stderr=["--set:1:1: error: unknown key", "did you mean `axial_force`?"])
expect(run("check", "good.toml", "--set", "end.axial_force=-2", "--set", "title=other"), 0, stdout=["other"])

expect(run("check", "none.toml"), 6, stderr=["none.toml"])
expect(run("check", "."), 6, stderr=["directory"])
points = CASE.replace('kind = "straight"\nlength = 1.0', 'kind = "points"\nfile = "none.csv"')
pathlib.Path("points.toml").write_text(points)
expect(run("check", "points.toml"), 6, stderr=["points.toml:12:8: error: cannot read", "none.csv"])

pathlib.Path("nan.csv").write_text("x,y,z\n0,0,0\n0,0,nan\n0,0,2\n")
pathlib.Path("points.toml").write_text(points.replace("none.csv", "nan.csv"))
expect(run("check", "points.toml"), 3, stderr=["nan.csv:3:1: error: this is not a finite number"])

expect(run("run", "good.toml", "--from", "none.json"), 6, stderr=["none.json"])
pathlib.Path("other.json").write_text("{}")
expect(run("run", "good.toml", "--from", "other.json"), 3, stderr=["other.json:1:1: error: this is not a result file"])
expect(run("run", "good.toml", "--out", "/proc/none"), 6, stderr=["/proc/none"])
with open("/dev/full", "w") as full:
    expect(run("check", "good.toml", stdout=full), 6, stderr=["standard output"])
