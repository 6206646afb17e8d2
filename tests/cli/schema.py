"""The schema accepts every example and refuses what the program refuses. The part of draft-07 that the schema uses is
checked here; where the jsonschema package is present it has to agree."""

import copy
import json
import tomllib

from _tendril import CASE, EXAMPLES, expect, run

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool}


def has_type(value, name):
    if name == "number":
        return isinstance(value, (int, float)) and not isinstance(value, bool)
    if name == "integer":
        return isinstance(value, int) and not isinstance(value, bool)
    return isinstance(value, TYPES[name])


def valid(value, schema):
    known = {"$schema", "title", "description", "type", "properties", "additionalProperties", "required", "enum",
             "const", "anyOf", "allOf", "not", "if", "then", "items", "minItems", "maxItems",
             "minLength", "minimum", "maximum", "exclusiveMinimum"}
    assert set(schema) <= known, set(schema) - known
    if "type" in schema and not has_type(value, schema["type"]):
        return False
    if "enum" in schema and value not in schema["enum"]:
        return False
    if "const" in schema and value != schema["const"]:
        return False
    if "anyOf" in schema and not any(valid(value, s) for s in schema["anyOf"]):
        return False
    if not all(valid(value, s) for s in schema.get("allOf", [])):
        return False
    if "not" in schema and valid(value, schema["not"]):
        return False
    if "if" in schema and valid(value, schema["if"]) and not valid(value, schema["then"]):
        return False
    if isinstance(value, dict):
        properties = schema.get("properties", {})
        if any(key not in value for key in schema.get("required", [])):
            return False
        if schema.get("additionalProperties", True) is False and any(key not in properties for key in value):
            return False
        return all(valid(v, properties[k]) for k, v in value.items() if k in properties)
    if isinstance(value, list):
        if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
            return False
        return all(valid(v, schema["items"]) for v in value) if "items" in schema else True
    if isinstance(value, str):
        return len(value) >= schema.get("minLength", 0)
    if has_type(value, "number"):
        return (value >= schema.get("minimum", value) and value <= schema.get("maximum", value)
                and ("exclusiveMinimum" not in schema or value > schema["exclusiveMinimum"]))
    return True


schema = json.loads(expect(run("schema"), 0).stdout)
try:
    import jsonschema
    second = jsonschema.Draft7Validator(schema).is_valid
except ImportError:
    second = None


def check(case, expected, what):
    assert valid(case, schema) == expected, what
    if second is not None:
        assert second(case) == expected, f"jsonschema: {what}"


names = sorted(EXAMPLES.glob("*.toml"))
assert len(names) >= 10
for name in names:
    check(tomllib.loads(name.read_text()), True, name)

good = tomllib.loads(CASE)
check(good, True, "the good case")


def changed(path, value):
    case = copy.deepcopy(good)
    *tables, key = path.split(".")
    at = case
    for table in tables:
        at = at.setdefault(table, {})
    if value is None:
        del at[key]
    else:
        at[key] = value
    return case


WRONG = {
    "schema": 2, "rod.bending_stiffness": -1.0, "rod.bendingstiffness": 1.0, "tube.side": "insid",
    "tube.axis.pitch_angle": 0.3, "start.eccentricity": [0.1], "start.kind": "free", "end.torque": True,
    "tube.axis.kind": None, "start": None, "units": 3, "path": {"values": [1]}, "tube.clearance": [[0.0, 0.1]],
    "rod.section": [{"to": 1.0, "measured_from": "tip"}],
}
for path, value in WRONG.items():
    check(changed(path, value), False, (path, value))
check(changed("end.axial_force", "-12 klbf"), True, "a quantity as a string")
check(changed("tube.clearance", [[0.0, 0.1], [1.0, "10 mm"]]), True, "a table of clearances")
