#!/usr/bin/env python3
"""Draws states of a result file as one SVG: left, rods in the tube in an oblique view; right, gap and pressure along it.

    tendril run examples/helix_outer_20.toml --json result.json --fields
    tools/draw_state.py result.json picture.svg --values=-14.14,-35.35,-141.4 --unit 7.069032971 --unit-name '|T0|'

Reads S, x, y, z, gap and pressure of the fields and the contacts; the tube is drawn from the case: a helix, an arc or a
straight line of one clearance. The band is the room of the centreline: bore less rod. Needs Python only.
"""
import argparse
import json
import math
from xml.sax.saxutils import escape

INK, GREY, TUBE = "#20262e", "#6b7480", "#9fb4c7"
STATE = ["#2a6fb0", "#3d8b40", "#7a4fa3"]  # one colour per state
CONTACT = "#d1432f"
FONT = "font-family='Helvetica, Arial, DejaVu Sans, sans-serif'"


def sub(a, b):
    return [p - q for p, q in zip(a, b)]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    n = math.sqrt(dot(a, a))
    return [p / n for p in a]


def axis_of(case, S):
    """Axis and tangent at S: exact for the kinds in closed form that are commonly drawn."""
    axis = case["tube"]["axis"]
    if axis["kind"] == "helix":
        r, a = axis["radius"], axis["pitch_angle"]
        w, turn = S * math.sin(abs(a)) / r, math.copysign(1.0, a)
        c, s = math.cos(w), math.sin(w)
        return ([r * c, turn * r * s, S * math.cos(a)],
                [-math.sin(abs(a)) * s, turn * math.sin(abs(a)) * c, math.cos(a)])
    if axis["kind"] == "straight":
        d = unit(axis.get("direction", [0, 0, 1]))
        o = axis.get("origin", [0, 0, 0])
        return [o[i] + S * d[i] for i in range(3)], d
    if axis["kind"] == "arc":
        r = axis["radius"]
        return ([r * (1 - math.cos(S / r)), 0.0, r * math.sin(S / r)], [math.sin(S / r), 0.0, math.cos(S / r)])
    raise SystemExit(f"draw_state.py: cannot draw the tube of an axis of kind {axis['kind']!r} (helix, straight, arc)")


class View:
    """Parallel projection: `right` and `up` span the sheet, `towards` points to the reader."""

    def __init__(self, towards, up):
        self.towards = unit(towards)
        self.right = unit(cross(up, self.towards))
        self.up = cross(self.towards, self.right)

    def __call__(self, p):
        return dot(p, self.right), dot(p, self.up)


def path(points, close=False):
    return "M" + " L".join(f"{x:.1f},{y:.1f}" for x, y in points) + ("Z" if close else "")


def text(x, y, s, size=13, anchor="start", fill=INK, extra=""):
    return (f"<text x='{x:.1f}' y='{y:.1f}' {FONT} font-size='{size}' text-anchor='{anchor}' fill='{fill}' {extra}>"
            f"{escape(s)}</text>")


def number(v):
    return f"{v:.6g}".replace("-", "\u2212")


def ticks(low, high, wanted=5):
    raw = (high - low) / wanted
    step = 10 ** math.floor(math.log10(raw))
    step *= next(m for m in (1, 2, 5, 10) if m * step >= raw * 0.999)
    first = math.ceil(low / step - 1e-9)
    return [i * step for i in range(first, math.floor(high / step + 1e-9) + 1)]


def in_contact(step, S):
    """Index of the contact that holds S, or None."""
    for i, c in enumerate(step["contacts"]):
        if c["kind"] == "line" and c["start"] <= S <= c["end"]:
            return i
    return None


def tube_and_rods(result, steps, box):
    """Tube and rods, one panel per state, side by side in the box (x, y, width, height)."""
    case, x0, y0, width, height = result["case"], *box
    S = steps[0]["fields"]["S"]
    places = [S[-1] * i / 240 for i in range(241)]
    centre = [axis_of(case, s) for s in places]
    first, last = centre[0][0], centre[-1][0]
    along = unit(sub(last, first))
    across = unit(cross(along, [0.2, 1.0, 0.15]))
    view = View(cross(across, along), along)
    radius = case["tube"].get("clearance")
    if not isinstance(radius, (int, float)):
        raise SystemExit("draw_state.py: draws tubes of one clearance only")
    sides = ([], [])
    for p, t in centre:
        x, y = view(p)
        tx, ty = view(t)
        n = math.hypot(tx, ty)
        # outline of a canal surface in parallel projection: offset by the radius, normal to the projected tangent
        for side, sign in zip(sides, (1, -1)):
            side.append((x - sign * radius * ty / n, y + sign * radius * tx / n))
    band = sides[0] + sides[1][::-1]
    low = [min(p[i] for p in band) for i in (0, 1)]
    high = [max(p[i] for p in band) for i in (0, 1)]
    panel = width / len(steps)
    scale = min((panel - 24) / (high[0] - low[0]), height / (high[1] - low[1]))
    out = []
    for k, step in enumerate(steps):
        shift = x0 + panel * (k + 0.5)

        def place(q):
            return (shift + scale * (q[0] - 0.5 * (low[0] + high[0])),
                    y0 + 0.5 * height - scale * (q[1] - 0.5 * (low[1] + high[1])))

        out.append(f"<path d='{path([place(q) for q in band], True)}' fill='{TUBE}' fill-opacity='0.28' stroke='none'/>")
        for side in sides:
            out.append(f"<path d='{path([place(q) for q in side])}' fill='none' stroke='{GREY}' stroke-width='1'/>")
        out.append(f"<path d='{path([place(view(p)) for p, _ in centre])}' fill='none' stroke='{GREY}' "
                   "stroke-width='0.8' stroke-dasharray='7 3 1.5 3'/>")
        f = step["fields"]
        rod = [place(view([f["x"][i], f["y"][i], f["z"][i]])) for i in range(len(f["S"]))]
        out.append(f"<path d='{path(rod)}' fill='none' stroke='{STATE[k]}' stroke-width='3.4' stroke-linecap='round'/>")
        for c in step["contacts"]:
            if c["kind"] == "line":
                piece = [q for q, s in zip(rod, f["S"]) if c["start"] - 1e-9 <= s <= c["end"] + 1e-9]
                out.append(f"<path d='{path(piece)}' fill='none' stroke='{CONTACT}' stroke-width='5' "
                           "stroke-linecap='round'/>")
            else:
                i = min(range(len(rod)), key=lambda j: abs(f["S"][j] - c["start"]))
                out.append(f"<circle cx='{rod[i][0]:.2f}' cy='{rod[i][1]:.2f}' r='5.5' fill='{CONTACT}'/>")
        for end in (rod[0], rod[-1]):
            out.append(f"<circle cx='{end[0]:.2f}' cy='{end[1]:.2f}' r='4' fill='white' stroke='{INK}' "
                       "stroke-width='1.6'/>")
    return out, [x0 + panel * (k + 0.5) for k in range(len(steps))]


def graph(steps, column, label, force_unit, box, S_label=None):
    low = 0.0
    x0, y0, width, height = box
    S_end = max(s["fields"]["S"][-1] for s in steps)
    top = max(max(s["fields"][column]) for s in steps) * 1.08 or 1.0  # points only: no pressure
    X = lambda s: x0 + width * s / S_end
    Y = lambda v: y0 + height * (1 - (v - low) / (top - low))
    out = []
    for v in ticks(low, top, 4):
        out.append(f"<line x1='{x0}' x2='{x0 + width}' y1='{Y(v):.1f}' y2='{Y(v):.1f}' stroke='#e3e7eb'/>")
        out.append(text(x0 - 8, Y(v) + 4.5, number(v), anchor="end"))
    for s in ticks(0, S_end, 5):
        out.append(f"<line x1='{X(s):.1f}' x2='{X(s):.1f}' y1='{y0 + height}' y2='{y0 + height + 5}' stroke='{INK}'/>")
        if S_label:
            out.append(text(X(s), y0 + height + 20, number(s), anchor="middle"))
    out.append(f"<path d='M{x0},{y0} V{y0 + height} H{x0 + width}' fill='none' stroke='{INK}'/>")
    out.append(text(x0, y0 - 11, label, 14))
    if S_label:
        out.append(text(x0 + width / 2, y0 + height + 42, S_label, 14, "middle"))
    for k, step in enumerate(steps):
        f = step["fields"]
        if column == "pressure":  # one curve a contact: it jumps at the ends of a line
            for i in range(len(step["contacts"])):
                p = [(X(s), Y(v)) for s, v in zip(f["S"], f[column]) if in_contact(step, s) == i and v != 0.0]
                if p:
                    out.append(f"<path d='{path([(p[0][0], Y(0))] + p + [(p[-1][0], Y(0))])}' fill='{STATE[k]}' "
                               f"fill-opacity='0.08' stroke='{STATE[k]}' stroke-width='2' stroke-linejoin='round'/>")
            for c in step["contacts"]:
                if c["kind"] == "point":
                    out.append(f"<circle cx='{X(c['start']):.1f}' cy='{Y(0):.1f}' r='5' fill='{STATE[k]}'/>")
                    out.append(text(X(c["start"]), Y(0) - 11, f"{number(float('%.3g' % c['force']))} {force_unit}", 12,
                                    "middle", STATE[k]))
        else:
            p = [(X(s), Y(v)) for s, v in zip(f["S"], f[column])]
            out.append(f"<path d='{path(p)}' fill='none' stroke='{STATE[k]}' stroke-width='2'/>")
    return out


def main():
    a = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    a.add_argument("result")
    a.add_argument("svg")
    a.add_argument("--values", help="parameters of the states to draw, comma separated (nearest steps are taken)")
    a.add_argument("--unit", type=float, default=1.0, help="the parameter is shown divided by this")
    a.add_argument("--unit-name", default="", help="and followed by this")
    a.add_argument("--name", default="end force", help="what the parameter is called in the picture")
    o = a.parse_args()
    with open(o.result, encoding="utf-8") as f:
        result = json.load(f)
    steps = [s for s in result["steps"] if s.get("fields", {}).get("S")]
    if not steps:
        raise SystemExit("draw_state.py: no fields in this result: run with --fields")
    if o.values:
        wanted = [float(v) for v in o.values.split(",")]
        steps = [min(steps, key=lambda s: abs(s["parameter"] - v)) for v in wanted]
    steps = steps[: len(STATE)]

    if result["case"].get("units") == "si":
        length, force, pressure = "m", "N", "N/m"
    else:
        length, force, pressure = "L", "B/L²", "B/L³"
    W, H = 1180, 560
    svg = [f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {W} {H}' width='{W}' height='{H}' role='img'>",
           f"<title>{escape(result['case'].get('title', 'rod in a tube'))}</title>",
           f"<rect width='{W}' height='{H}' fill='white'/>"]
    drawing, middles = tube_and_rods(result, steps, (14, 84, 560, 410))
    svg += drawing
    for k, (step, x) in enumerate(zip(steps, middles)):
        value = step["parameter"]
        shown = "" if value is None else number(float("%.4g" % (value / o.unit))) + (" " + o.unit_name).rstrip()
        lines = sum(c["kind"] == "line" for c in step["contacts"])
        points = len(step["contacts"]) - lines
        words = [f"{n} {w}{'s' if n > 1 else ''}" for n, w in ((points, "point"), (lines, "line")) if n]
        svg.append(text(x, 34, shown, 17, "middle", STATE[k], "font-weight='bold'"))
        svg.append(text(x, 56, "contact: " + ", ".join(words) if words else "no contact", 13, "middle", GREY))
    y = H - 26
    svg.append(f"<line x1='30' x2='58' y1='{y - 4}' y2='{y - 4}' stroke='{STATE[0]}' stroke-width='3.4'/>")
    svg.append(text(66, y, "rod, free"))
    svg.append(f"<line x1='148' x2='176' y1='{y - 4}' y2='{y - 4}' stroke='{CONTACT}' stroke-width='5'/>")
    svg.append(text(184, y, "rod on the wall"))
    svg.append(f"<line x1='300' x2='328' y1='{y - 4}' y2='{y - 4}' stroke='{GREY}' stroke-dasharray='7 3 1.5 3'/>")
    svg.append(text(336, y, "axis of the tube"))
    svg.append(f"<rect x='456' y='{y - 12}' width='28' height='16' fill='{TUBE}' fill-opacity='0.35' stroke='{GREY}'/>")
    svg.append(text(492, y, "room for the"))
    svg.append(text(492, y + 16, "centreline"))
    gx, gw = 660, 490
    svg += graph(steps, "gap", f"gap between rod and wall  [{length}]", force, (gx, 52, gw, 170))
    svg += graph(steps, "pressure", f"pressure of the wall  [{pressure}]; dot: force of a point contact", force,
                 (gx, 282, gw, 170), f"S along the axis of the tube  [{length}]")
    x = gx
    with_parameter = all(s["parameter"] is not None for s in steps)
    svg.append(text(x, H - 26, o.name + ":") if with_parameter else "")
    x += 14 + 7 * len(o.name)
    for k, step in enumerate(steps if with_parameter else []):
        shown = number(float("%.4g" % (step["parameter"] / o.unit))) + (" " + o.unit_name).rstrip()
        svg.append(f"<line x1='{x + 4}' x2='{x + 30}' y1='{H - 30}' y2='{H - 30}' stroke='{STATE[k]}' stroke-width='2.5'/>")
        svg.append(text(x + 37, H - 26, shown))
        x += 62 + 8 * len(shown)
    svg.append("</svg>")
    with open(o.svg, "w", encoding="utf-8") as f:
        f.write("\n".join(svg) + "\n")


if __name__ == "__main__":
    main()
