"""Many solves side by side: the same bits for any number of threads, and the interpreter free meanwhile."""

import threading
import time

import numpy as np
import pytest
import tendril
from conftest import EXAMPLES


@pytest.fixture(scope="module")
def helix():
    return tendril.load(EXAMPLES / "helix_outer_20.toml", {"path": None})


def bits(results):
    return [[r.fields[name].tobytes() for name in r.fields] + [r.state.tobytes(), r.contacts.tobytes()] for r in results]


def test_same_bits_for_any_number_of_threads(helix):
    forces = np.array([-8.0, -10.0, -20.0, -40.0])
    one, three = (tendril.solve_many(helix, {"end.axial_force": forces}, threads=n, points=101) for n in (1, 3))
    assert bits(one) == bits(three)
    alone = [helix.replace({"end.axial_force": f}).solve(points=101) for f in forces]
    assert bits(alone) == bits(one)
    assert one.converged.all() and [r.axial_force_end for r in one] == pytest.approx(list(forces), rel=1e-8)


def test_several_keys_and_broadcast(helix):
    forces = np.array([-10.0, -20.0, -30.0])
    many = tendril.solve_many(helix, {"end.axial_force": forces, "tube.clearance": 0.045})
    assert many.samples == {"end.axial_force": list(forces), "tube.clearance": [0.045] * 3}
    frame = many.to_pandas()
    assert list(frame["end.axial_force"]) == list(forces) and set(frame["status"]) == {"converged"}
    assert np.array_equal(frame["rod_length"], many.values("rod_length"))
    assert np.all(np.diff(many.values("rod_length")) > 0)  # more force, more rod in the tube
    with pytest.raises(ValueError, match="tube.clearance"):
        tendril.solve_many(helix, {"end.axial_force": forces, "tube.clearance": [0.045, 0.05]})


def test_a_list_of_cases(straight, helix):
    many = tendril.solve_many([tendril.Case(straight), helix], threads=2)
    assert len(many) == 2 and many[0].case.parameter is None and many[1].converged
    assert len(many[0].fields.S) == 0  # none were asked for


def test_wrong_samples_are_named(helix):
    with pytest.raises(tendril.CaseError) as caught:
        tendril.solve_many(helix, {"tube.clearance": [0.05, -1.0, 0.04, 0.0]})
    assert [error.path for error in caught.value.errors] == ["sample 1, --set", "sample 3, --set"]


def test_a_failed_solve_stays_in_its_place(held):
    many = tendril.solve_many(tendril.Case(held), {"end.rod_length": [1.001, 0.9, 1.002]})
    assert list(many.converged) == [True, False, True]
    assert np.isnan(many.values("rod_length")[1]) and many[1].message


def test_the_interpreter_is_free_meanwhile(helix):
    """Another thread of Python runs while the solves do."""
    ticks, over = [], threading.Event()

    def tick():
        while not over.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    began = time.monotonic()
    tendril.solve_many(helix, {"end.axial_force": np.full(8, -20.0)}, threads=1)
    ended = time.monotonic()
    over.set()
    thread.join()
    during = [t for t in ticks if began < t < ended]
    assert len(during) > 5, (len(during), ended - began)
