"""Views without copies, tables, and how long they live."""

import gc

import numpy as np
import pandas as pd
import pytest
import tendril
from conftest import EXAMPLES


@pytest.fixture(scope="module")
def helix():
    return tendril.load(EXAMPLES / "helix_outer_20.toml").solve()


def test_columns_are_views_and_read_only(helix):
    for name, column in helix.fields.items():
        assert not column.flags.owndata and not column.flags.writeable, name
        assert column.dtype == np.float64 and column.ndim == 1
        with pytest.raises(ValueError):
            column[0] = 1.0
    # asked for again, the same memory
    assert helix.x.ctypes.data == helix.fields["x"].ctypes.data == helix.steps[-1].fields.x.ctypes.data
    assert not helix.state.flags.writeable


def test_a_view_outlives_its_result():
    result = tendril.load(EXAMPLES / "s_bend.toml").solve()
    x, copy = result.x, result.x.copy()
    del result
    gc.collect()
    rubbish = [np.full(405, np.nan) for _ in range(200)]  # would overwrite memory that had been given back
    assert np.array_equal(x, copy) and len(rubbish) == 200


def test_columns_agree_with_each_other(helix):
    """The centreline is the axis plus the eccentricity, |δ| = clearance - gap; s grows to the rod's length."""
    f = helix.fields
    rounding = 1e-12  # a few operations on numbers of order 1
    assert np.allclose(np.hypot(f.delta1, f.delta2), 0.05 - f.gap, rtol=0, atol=rounding)
    assert abs(f.s[0]) < rounding and abs(f.s[-1] - helix.rod_length) < 1e-9 and np.all(np.diff(f.s) >= 0)
    assert helix.units["F3"] == "" and helix.units["phi"] == "rad"


def test_tables(helix):
    contacts = helix.contacts
    assert contacts.dtype.names[:3] == ("kind", "start", "end")
    assert list(contacts.kind) == ["line", "line"] and np.all(contacts.force > 0)
    assert contacts.force_vector.shape == (2, 3)
    assert helix.force_max == contacts.force.max()
    with pytest.raises(ValueError):
        contacts.force[0] = 0.0
    frame = contacts.to_pandas()
    assert isinstance(frame, pd.DataFrame) and len(frame) == 2 and "force_vector_z" in frame
    assert np.array_equal(frame["force"], contacts["force"])
    # the wall pushes with the sum of the line's force densities, never less than their resultant
    assert np.all(np.linalg.norm(contacts.force_vector, axis=1) <= contacts.force)

    steps = helix.to_pandas()
    assert list(steps["parameter"]) == [step.parameter for step in helix.steps]
    assert list(helix.fields.to_pandas().columns) == list(helix.fields)
    assert list(helix.events.to_pandas()["kind"]) == ["contact_appears", "point_to_line", "line_splits"]


def test_no_contact_is_an_empty_table(helix):
    first = helix.steps[0]
    assert len(first.contacts) == 0 and first.force_max == 0.0
    assert first.contacts.force.shape == (0,) and len(first.contacts.to_pandas()) == 0


def test_words(helix):
    assert repr(helix) == "<tendril.Result converged: 6 steps, 3 events, 2 contacts in the last>"
    assert "helix of length 1" in repr(helix.case)
    assert "axial_force" in tendril.explain("end") and tendril.schema()["type"] == "object"
    with pytest.raises(KeyError):
        tendril.explain("rod.none")
