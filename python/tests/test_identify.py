"""Fields found from measurements are those of the command line."""

import csv
import json

import numpy as np
import pytest
import vibroimpact
from conftest import REPOSITORY, SCENES
from test_same_as_command_line import plain

TABLES = REPOSITORY / "datasets" / "identification"
BAR = SCENES / "rubber-ball.json"
FREE = ["contact.striker_youngs_modulus_pa", "contact.restitution"]


def columns(path):
    """A table of numbers as arrays."""
    with path.open(newline="") as file:
        names, *rows = csv.reader(file)
    return {name: np.array([float(cell or "nan") for cell in column]) for name, column in zip(names, zip(*rows))}


@pytest.fixture(scope="module")
def found():
    return vibroimpact.identify(BAR, TABLES / "rubber-ball.csv", FREE)


def test_the_command_line_finds_the_same(found, command_line):
    assert plain(found) == command_line("identify", TABLES / "rubber-ball.csv", "--scene", BAR, "--free", ",".join(FREE))


def test_columns_are_equivalent_to_a_file(found):
    table = columns(TABLES / "rubber-ball.csv")
    assert vibroimpact.identify(json.loads(BAR.read_text()), table, FREE) == found
    pandas = pytest.importorskip("pandas")
    assert vibroimpact.identify(BAR, pandas.DataFrame(table), FREE) == found


def test_the_result_by_name(found):
    assert list(found.parameters) == FREE
    for field, value in found.parameters.items():
        low, high = found.intervals[field]
        assert low < value < high
    # The true values of the table.
    assert found.intervals[FREE[0]][0] < 4.2e6 < found.intervals[FREE[0]][1]
    assert found.intervals[FREE[1]][0] < 0.74 < found.intervals[FREE[1]][1]


def test_the_picture(found):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    first, second, misfits = found.plot().axes
    assert [first.get_xlabel(), second.get_xlabel()] == FREE
    assert max(np.abs(line.get_ydata()).max() for line in misfits.lines) < 4


def test_limits_candidates_and_level():
    limits = {FREE[0]: (2e6, 9e6), FREE[1]: None}
    narrow = vibroimpact.identify(
        BAR, TABLES / "rubber-ball.csv", limits, level=0.5, starts=2, candidates=columns(TABLES / "rubber-ball-next.csv")
    )
    assert narrow["level"] == 0.5 and len(narrow["starts"]) == 2
    assert [entry["line"] for entry in narrow["candidates"]] and narrow["candidates"][0]["volume_ratio"] < 1
    same = vibroimpact.identify(
        BAR, TABLES / "rubber-ball.csv", limits, level=0.5, starts=2, candidates=TABLES / "rubber-ball-next.csv"
    )
    assert same == narrow


def test_invalid_input():
    table = columns(TABLES / "rubber-ball.csv")
    with pytest.raises(vibroimpact.InvalidInput, match="^column location_m = 3 values is not allowed; it must be as long"):
        vibroimpact.identify(BAR, table | {"location_m": [0.1, 0.2, 0.3]}, FREE)
    with pytest.raises(vibroimpact.InvalidInput, match="^line 2, first_contact_s = -"):
        vibroimpact.identify(BAR, table | {"first_contact_s": -table["first_contact_s"]}, FREE)
    with pytest.raises(vibroimpact.InvalidInput, match="free"):
        vibroimpact.identify(BAR, table, {FREE[0]: (9.0, 1.0)})
    with pytest.raises(vibroimpact.InvalidInput, match="free"):
        vibroimpact.identify(BAR, table, [])
    with pytest.raises(vibroimpact.InvalidInput, match="level"):
        vibroimpact.identify(BAR, table, FREE, level=2)
    with pytest.raises(TypeError, match="a list of fields"):
        vibroimpact.identify(BAR, table, FREE[0])
    with pytest.raises(TypeError, match="columns or the path of a file, not int"):
        vibroimpact.identify(BAR, 3, FREE)
    with pytest.raises(FileNotFoundError):
        vibroimpact.identify(BAR, "no-such-table.csv", FREE)
