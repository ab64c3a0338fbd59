"""The code in the documents about the package runs."""

import doctest
import os
import re

import pytest
from conftest import REPOSITORY


def test_readme():
    found = doctest.testfile(str(REPOSITORY / "python" / "README.md"), module_relative=False)
    assert found.attempted > 5 and found.failed == 0


HOW_TO = REPOSITORY / "docs" / "how-to"
# Pages with snippets, and the packages that they need besides numpy.
PAGES = {
    "python.md": ["matplotlib", "pandas"],
    "structures-calculix.md": [],
    "structures-matrices.md": ["scipy"],
    "structures-nastran.md": ["pyNastran"],
    "structures-test.md": [],
    "structures-universal.md": ["pyuff"],
}


@pytest.mark.parametrize("page", PAGES)
def test_how_to(page, monkeypatch, capsys):
    for module in PAGES[page]:
        pytest.importorskip(module)
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.chdir(REPOSITORY)
    text = (HOW_TO / page).read_text()
    snippets = re.findall(r"^```python\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)
    assert len(snippets) > (5 if page == "python.md" else 0)
    names = {}
    for snippet in snippets:
        exec(compile(snippet, page, "exec"), names)
    # The output follows the snippet that prints it.
    printed = re.findall(r"^```python\n.*?^```\n\n```text\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)
    assert capsys.readouterr().out == "".join(printed)


def test_readme_of_the_workspace(capsys):
    text = (REPOSITORY / "README.md").read_text()
    (snippet,) = re.findall(r"^```python\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)
    exec(compile(snippet, "README.md", "exec"), {})
    assert capsys.readouterr().out == "0.333 after 5 contacts\n"


# Notebooks, the numbers of their figures, and those of their tables.
NOTEBOOKS = {"thesis.ipynb": (6, 0), "identification.ipynb": (3, 3)}


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_notebook(name, monkeypatch):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    monkeypatch.setenv("VIBROIMPACT_QUICK", "1")
    notebook = nbformat.read(REPOSITORY / "python" / "notebooks" / name, as_version=4)
    environment = os.environ | {"JUPYTER_PLATFORM_DIRS": "1"}
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute(env=environment)
    shown = [output.get("data", {}) for cell in notebook.cells for output in cell.get("outputs", [])]
    drawn = sum("image/png" in data for data in shown)
    assert (drawn, sum("text/html" in data for data in shown)) == NOTEBOOKS[name]
