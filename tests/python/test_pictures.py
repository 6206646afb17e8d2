"""Pages, pictures and plots of a result."""

import xml.etree.ElementTree as ET

import matplotlib.pyplot as plt
import numpy as np
import pytest
import tendril
from conftest import EXAMPLES
from tendril import _core, plot


@pytest.fixture(scope="module")
def helix():
    return tendril.load(EXAMPLES / "helix_outer_20.toml").solve()


@pytest.fixture(scope="module")
def wire():
    return tendril.load(EXAMPLES / "guidewire_vessel.toml").solve()


@pytest.mark.skipif(not _core.HAS_PAGE, reason="built without Node, so without the page")
def test_report_is_the_programs(tmp_path, helix, program):
    saved, page = helix.save(tmp_path / "r.json"), tmp_path / "page.html"
    assert program("report", saved, "-o", page).returncode == 0
    assert helix.report() == page.read_text(encoding="utf-8")
    assert helix.report(tmp_path / "own.html").read_text(encoding="utf-8") == helix.report()
    shown = helix._repr_html_()
    assert shown.startswith('<iframe srcdoc="') and shown.count("<iframe") == 1 and "</iframe>" in shown[-10:]
    assert '"' not in shown[len('<iframe srcdoc="'):shown.index('" width=')]


def test_without_the_page_there_is_a_picture(monkeypatch, wire):
    monkeypatch.setattr(_core, "HAS_PAGE", False)
    assert "<svg" in wire._repr_html_()
    with pytest.raises(RuntimeError, match="Node"):
        wire.report()
    (bare,) = tendril.solve_many([wire.case])  # without fields there is nothing to draw
    assert bare._repr_html_() == "<pre>&lt;tendril.Result converged: 1 contact, stable&gt;</pre>"


def test_svg(helix, wire):
    root = ET.fromstring(helix.svg())
    text = "".join(root.itertext())
    assert root.tag.endswith("svg") and "Helical conduit" in text and "pressure of the wall" in text
    assert "curvature" in "".join(ET.fromstring(wire.svg()).itertext())  # points have no pressure
    assert helix.svg(0) != helix.svg(1) and helix.svg() == helix.svg(len(helix.steps) - 1)


def test_tracks_show_the_fields(wire):
    figure = plot.tracks(wire, ("gap", "F3"), offset=1.0)
    gap, force = figure.axes
    assert np.array_equal(gap.lines[-1].get_ydata(), wire.gap)
    assert np.array_equal(force.lines[-1].get_xdata(), wire.S + 1.0)
    assert gap.get_ylabel() == "gap [m]" and force.get_xlabel() == "S [m]"
    assert gap.lines[0].get_xdata()[0] == wire.contacts.start[0] + 1.0  # the point contact
    plt.close(figure)


def test_vertical_tracks_run_downwards(helix):
    figure = plot.tracks(helix, vertical=True)
    low, high = figure.axes[0].get_ylim()
    assert low > high and len(figure.axes[0].patches) == len(helix.contacts)  # a band per line contact
    plt.close(figure)


def test_response(helix):
    axes = plot.response(helix)
    assert np.array_equal(axes.lines[0].get_xdata(), helix.trace.parameter)
    assert [t.get_text() for t in axes.get_legend().get_texts()][0].startswith("1  contact appears at -9.12")
    plt.close(axes.figure)
