"""Rods in motion: the session of the library and [insertion], the same numbers as the program's."""

import json
import os
import signal
import threading

import numpy as np
import pytest
import tendril


@pytest.fixture
def bend():
    """A wire fed into an arc until its tip slides along the outer wall."""
    return tendril.Case(
        rod={"bending_stiffness": 1.0, "torsional_stiffness": 0.75},
        tube={"clearance": 0.02, "axis": {"kind": "arc", "radius": 0.3, "length": 1.5}},
        start={"kind": "clamped"},
        end={"kind": "free", "position": 0.2},
    )


def test_session_goes_the_way_of_insert(bend):
    session = tendril.Session(bend)
    start = session.fed
    result = tendril.insert(bend, to=start + 0.6, step=0.1)
    assert result.converged and len(result.steps) == 6
    for i, step in enumerate(result.steps):
        # one subtraction may round otherwise than the list of lengths: the state agrees to rounding
        assert session.advance(start + 0.1 * (i + 1) - session.fed)
        assert session.fed == pytest.approx(step.parameter, rel=1e-14)
        np.testing.assert_allclose(session.contacts["start"], step.contacts["start"], rtol=1e-9)
        np.testing.assert_allclose(session.contacts["force"], step.contacts["force"], rtol=1e-7)
    assert [e["kind"] for e in session.events] == [e["kind"] for e in result.events]


def test_insert_is_the_program_with_the_table(bend, program, tmp_path):
    here = tendril.insert(bend, values=[0.4, 0.8, 0.5], step=0.05)
    assert here.converged
    (tmp_path / "case.toml").write_text(bend.text + "\n[insertion]\nvalues = [0.4, 0.8, 0.5]\nstep = 0.05\n")
    ran = program("run", "case.toml", "--json", "-", "--quiet", directory=tmp_path)
    assert ran.returncode == 0, ran.stderr
    there = json.loads(ran.stdout)
    for step, told in zip(here.steps, there["steps"], strict=True):
        assert step.rod_length == told["rod_length"]
        assert step.contacts["force"].tolist() == [c["force"] for c in told["contacts"]]
        assert step.state.tolist() == told["state"]
    assert here.trace["rod_length"].tolist() == [t["rod_length"] for t in there["trace"]]
    # a table in place of the one there
    again = tendril.insert(here.case, to=0.3, step=0.1)
    assert again.rod_length == pytest.approx(0.3, rel=1e-12)
    assert again.case.follow("rod.bending_stiffness", [1.1]).parameter == 1.1


def test_withdrawal_comes_back(bend):
    session = tendril.Session(bend)
    session.advance(0.2)
    before = session.state()
    for by in (0.25, 0.15, -0.15, -0.25):
        assert session.advance(by)
    after = session.state()
    # no jump on the way: the same state, to the accuracy of a state (1e-8 of a length) and its force
    assert "jump" not in after.events["kind"]
    np.testing.assert_allclose(after.contacts["start"], before.contacts["start"], rtol=1e-7)
    np.testing.assert_allclose(after.contacts["force"], before.contacts["force"], rtol=1e-6)


def test_snapshot_and_turn(bend):
    session = tendril.Session(bend)
    session.advance(0.3)
    kept, fed, force = session.snapshot(), session.fed, session.contacts["force"].tolist()
    assert session.rotate(1.0) and session.rotation == 1.0
    assert session.advance(0.2) and session.fed != fed
    session.restore(kept)
    assert (session.fed, session.rotation) == (fed, 0.0)
    np.testing.assert_allclose(session.contacts["force"], force, rtol=1e-9)
    # an arc is planar and the wire round and straight: turning it changes nothing but its angle
    assert session.rotate(0.5)
    np.testing.assert_allclose(session.contacts["force"], force, rtol=1e-6)


def test_what_cannot_be(bend):
    session = tendril.Session(bend)
    motion = session.advance(10.0)  # the axis is 1.5 long
    assert not motion and not motion.reached and motion.reason
    assert session.state().converged and session.fed < 2.0
    with pytest.raises(ValueError, match="finite"):
        session.advance(float("nan"))
    with pytest.raises(tendril.CaseError) as wrong:
        tendril.insert(bend, to=1.0, values=[1.0])
    assert [e.key for e in wrong.value.errors] == ["insertion.to"]
    with pytest.raises(tendril.CaseError):
        tendril.insert(bend)


def test_interrupted_motion_keeps_the_last_state(bend):
    session = tendril.Session(bend)
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100000):
            session.advance(1e-5)
    assert session.state().converged
    assert session.advance(1e-3)


def test_threads_take_turns(bend):
    session = tendril.Session(bend)
    start, failed = session.fed, []

    def push():
        for _ in range(5):
            if not session.advance(0.01) or not session.state(points=11).converged:
                failed.append(session.fed)

    threads = [threading.Thread(target=push) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed
    assert session.fed == pytest.approx(start + 0.15, rel=1e-12)
