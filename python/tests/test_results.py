"""Results beyond their entries: names, pictures, notebooks, data frames."""

import sys
from html.parser import HTMLParser

import numpy as np
import pytest
import vibroimpact
from conftest import ASSEMBLIES, SCENES

BAR = SCENES / "rubber-ball.json"


@pytest.fixture
def pyplot():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    from matplotlib import pyplot

    yield pyplot
    pyplot.close("all")


def test_entries_by_name(scene):
    found = vibroimpact.simulate(scene)
    assert isinstance(found, vibroimpact.Impact) and isinstance(found, dict)
    for name in ("outcome", "restitution", "restitution_uncertainty"):
        assert getattr(found, name) == found[name]
    assert found.sub_impacts is found["sub_impacts"] and found.history is None
    assert len(vibroimpact.simulate(scene, history=True).history["time_s"]) > 100
    bodies = vibroimpact.simulate(ASSEMBLIES / "dropped-ball.json")
    assert isinstance(bodies, vibroimpact.Motion) and bodies.contacts is bodies["contacts"]
    assert type(vibroimpact.plan(scene)) is vibroimpact.Result


def test_an_impact_is_plotted(scene, pyplot):
    with_history = vibroimpact.simulate(scene, history=True)
    # A result without history is solved once more, with the same outcome.
    for found in (with_history, vibroimpact.simulate(scene)):
        motion, force = found.plot().axes
        np.testing.assert_array_equal(force.lines[0].get_ydata(), with_history.history["force_n"])
        # without a gap at the start, the surface of the striker moves as the striker
        np.testing.assert_allclose(motion.lines[0].get_ydata(), 1e3 * with_history.history["striker_displacement_m"], atol=1e-15)
        assert "restitution 0.1" in motion.get_title()
    with pytest.raises(ValueError, match="the model emoc has no motion in time"):
        vibroimpact.simulate(scene | {"model": "emoc", "modes": "auto"}).plot()


def test_bodies_are_plotted(pyplot):
    found = vibroimpact.simulate(ASSEMBLIES / "dropped-ball.json")
    gaps, forces = found.plot().axes
    assert len(gaps.lines) == len(found.contacts)
    # The ball rises some millimetres, sinks into the ground by less than a tenth of one, and has a force only there.
    gap_mm, force_n = gaps.lines[0].get_ydata(), forces.lines[0].get_ydata()
    assert 1 < gap_mm.max() < 10 and -0.1 < gap_mm.min() < 0
    assert force_n.max() > 0 and not force_n[gap_mm > 1e-6].any()


def test_without_matplotlib(scene, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(ImportError, match="pip install matplotlib"):
        vibroimpact.simulate(scene).plot()


class Reader(HTMLParser):
    """Reads a page and checks that its tags match."""

    def __init__(self):
        super().__init__()
        self.open, self.text = [], []

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)


def test_a_notebook_shows_results(scene):
    scene["description"] = "<b>sharp & bold</b>"
    for found in (vibroimpact.simulate(scene, history=True), vibroimpact.compare(scene), vibroimpact.plan(scene)):
        reader = Reader()
        reader.feed(found._repr_html_())
        assert reader.open == []
    found = vibroimpact.simulate(scene)
    reader = Reader()
    reader.feed(found._repr_html_())
    assert "restitution" in reader.text and "<b>sharp & bold</b>" in reader.text
    count = found["sub_impact_count"]
    columns = ", ".join(found.sub_impacts.dtype.names)
    assert columns.startswith("start_s, end_s, ") and "peak_force_uncertainty_solver_n" in columns
    assert f"array of shape ({count},) with the columns {columns}" in reader.text


def test_data_frames(scene):
    pandas = pytest.importorskip("pandas")
    found = vibroimpact.simulate(scene, history=True)
    contacts, history = pandas.DataFrame(found.sub_impacts), pandas.DataFrame(found.history)
    assert contacts["peak_force_n"].max() == found.sub_impacts["peak_force_n"].max()
    assert len(history) == len(found.history["time_s"])
    speeds = {"scene": scene, "vary": [{"field": "striker.speed_m_s", "from": 0.5, "to": 2, "count": 4}]}
    sweep = pandas.DataFrame(vibroimpact.sweep(speeds))
    assert list(sweep["striker.speed_m_s"]) == [0.5, 1.0, 1.5, 2.0] and (sweep["error"] == "").all()
