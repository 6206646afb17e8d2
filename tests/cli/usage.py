"""Commands, help, wrong usage and their exit codes."""

import json

from _tendril import expect, run

expect(run("--version"), 0, stdout=["tendril "])
expect(run("--help"), 0, stdout=["examples:", "tendril run", "exit codes", "explain", "verify"])
expect(run("run", "--help"), 0, stdout=["--set", "--from", "--max-seconds"])
expect(run(), 2, stderr=["subcommand"])
expect(run("rnu"), 2, stderr=["unknown command `rnu`", "did you mean `run`?"])
expect(run("chekc", "x.toml"), 2, stderr=["did you mean `check`?"])
expect(run("run"), 2, stderr=["CASE"])
expect(run("run", "x.toml", "--jsn", "y"), 2, stderr=["did you mean `--json`?"])
expect(run("run", "x.toml", "--max-seconds", "-1"), 2, stderr=["--max-seconds"])

expect(run("explain", "end.axial_force"), 0, stdout=["tension positive", "12 klbf"])
expect(run("explain", "tube.axis"), 0, stdout=["tube.axis.kind", "tube.axis.from", "tube.axis.to"])
expect(run("explain"), 0, stdout=["rod", "tube", "path"])
expect(run("explain", "end.axial_forse"), 2, stderr=["did you mean `axial_force`?"])

schema = json.loads(expect(run("schema"), 0).stdout)
assert schema["$schema"].startswith("http://json-schema.org/draft-07"), schema["$schema"]
