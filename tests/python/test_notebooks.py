"""The notebooks run from top to bottom, and each shows what it promises."""

import os
import re

import nbformat
import pytest
from conftest import SOURCE
from nbclient import NotebookClient

NOTEBOOKS = SOURCE / "python" / "notebooks"


def outputs(name, tmp_path):
    notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "notebooks are stored without outputs"
    (tmp_path / "python").mkdir()
    os.symlink(SOURCE / "examples", tmp_path / "examples")
    work = tmp_path / "python" / "notebooks"
    work.mkdir()
    NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(work)}}).execute()
    if keep := os.environ.get("TENDRIL_KEEP_NOTEBOOKS"):
        nbformat.write(notebook, os.path.join(keep, f"{name}.ipynb"))
    shown = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    text = "\n".join(output.get("text", "") or str(output.get("data", {}).get("text/plain", "")) for output in shown)
    pictures = sum("image/png" in output.get("data", {}) for output in shown)
    pages = [output["data"]["text/html"] for output in shown if "<iframe srcdoc=" in output.get("data", {}).get("text/html", "")]
    return text, pictures, pages, work


def test_driller(tmp_path):
    text, pictures, pages, work = outputs("driller", tmp_path)
    assert "converged, stable" in text and pictures == 1 and text.count("not_converged") == 0
    assert len(pages) <= 1 and (work / "forge" / "contacts.csv").is_file()


def test_device_engineer(tmp_path):
    text, pictures, _, _ = outputs("device_engineer", tmp_path)
    assert pictures == 2 and text.count("converged") == 13 and "not_converged" not in text
    assert "did you mean `diameter`?" in text and "end.axial_force" in text


def test_researcher(tmp_path):
    text, pictures, _, work = outputs("researcher", tmp_path)
    assert pictures == 2 and "owndata=False" in text and (work / "conduit.json").is_file()
    differences = [float(row.split()[-1]) for row in re.findall(r"(?:contact_appears|point_to_line|line_splits).*", text)]
    assert len(differences) == 3
    for difference in differences:
        assert abs(difference) < 1e-7  # printed digits of the independent computation


@pytest.fixture(autouse=True)
def quiet_kernels(monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    monkeypatch.setenv("PYDEVD_DISABLE_FILE_VALIDATION", "1")
