"""The notebooks run from their first cell to the last, each in a kernel of its own."""
import importlib.util
import pathlib

import pytest

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")
FOLDER = pathlib.Path(__file__).resolve().parents[2] / "python/notebooks"


def displayed(notebook):
    return "\n".join(
        str(output.get("text", "")) + str(output.get("data", {}))
        for cell in notebook.cells
        for output in cell.get("outputs", [])
    )


@pytest.mark.parametrize("name", ["camshaft", "genset", "moving"])
def test_notebook(name, root, tmp_path, monkeypatch):
    if name == "moving":
        for peer in ("opentorsion", "ross"):  # to import them takes long
            if importlib.util.find_spec(peer) is None:
                pytest.skip(f"{peer} is not installed")
    monkeypatch.setenv("DREV_MODELS", str(root / "models"))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    notebook = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells)  # what was computed is not kept in the tree
    nbclient.NotebookClient(notebook, timeout=240, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = displayed(notebook)
    if name != "moving":
        assert "<iframe srcdoc=" in shown  # the report
    else:
        assert shown.count("largest relative difference") == 4
