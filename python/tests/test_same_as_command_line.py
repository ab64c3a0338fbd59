"""The numbers, keys and messages are those of the command line."""

import csv
import json

import numpy as np
import pytest
import vibroimpact
from conftest import ASSEMBLIES, REPOSITORY, SCENES

GALLERY = sorted(path for path in SCENES.iterdir() if path.suffix in (".json", ".toml"))


def plain(value):
    """A result with its arrays as lists, as in JSON."""
    if isinstance(value, np.ndarray) and value.dtype.names:
        return [nested(dict(zip(value.dtype.names, map(plain, row.tolist())))) for row in value]
    if isinstance(value, np.ndarray) and value.dtype.kind == "c":
        return [[number.real, number.imag] for number in value.tolist()]
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, list):
        return [plain(entry) for entry in value]
    if isinstance(value, dict):
        return {name: plain(entry) for name, entry in value.items()}
    return None if isinstance(value, float) and np.isnan(value) else value


def nested(row):
    """A row whose columns of parts are one object, as in JSON."""
    columns = {part: f"peak_force_uncertainty_{part}_n" for part in ("solver", "modes_left_out", "beam_theory")}
    parts = {part: row.pop(column) for part, column in columns.items() if column in row}
    return row | {"peak_force_uncertainty_parts_n": parts} if parts else row


@pytest.mark.parametrize("path", GALLERY, ids=lambda path: path.name)
def test_simulate(path, command_line):
    assert plain(vibroimpact.simulate(path)) == command_line("simulate", path)


@pytest.mark.parametrize("path", sorted(ASSEMBLIES.glob("*.json")), ids=lambda path: path.name)
def test_simulate_bodies(path, command_line):
    assert plain(vibroimpact.simulate(path)) == command_line("simulate", path)


@pytest.mark.parametrize("name", ["rattling-gear", "sdnl105"])
def test_history_of_bodies(name, command_line, tmp_path):
    path = ASSEMBLIES / f"{name}.json"
    command_line("simulate", path, "--out", tmp_path)
    found = vibroimpact.simulate(path, history=True)
    for entry in ("history", "section"):
        if found[entry] is None:
            assert entry == "section" and name == "sdnl105"
            continue
        with open(tmp_path / f"{entry}.csv", newline="") as table:
            names, *rows = csv.reader(table)
        assert list(found[entry]) == names
        np.testing.assert_array_equal(np.array(list(found[entry].values())).T, np.array(rows, dtype=float))


def test_orbit(command_line, tmp_path):
    path = ASSEMBLIES / "shaken-table.json"
    found = vibroimpact.orbit(path)
    assert found["stable"] and found["intervals_per_period"] == 1
    assert plain(found) == command_line("orbit", path)
    assert np.abs(found["floquet_multipliers"]).max() < 1
    over = {"over": "ground_motion.displacement_m", "to": 0.001, "step": 0.05}
    branch = vibroimpact.orbit(path, **over)
    columns = branch.pop("columns")
    words = ("orbit", path, "--over", over["over"], "--to", over["to"], "--step", over["step"])
    assert plain(branch) == command_line(*words)
    command_line(*words, "--csv", tmp_path / "branch.csv")
    with open(tmp_path / "branch.csv", newline="") as table:
        names, *rows = csv.reader(table)
    assert list(columns) == names and columns["stable"].dtype == bool
    np.testing.assert_array_equal(columns[names[0]], [float(row[0]) for row in rows])
    np.testing.assert_array_equal(columns[names[0]], [orbit["value"] for orbit in branch["orbits"]])


@pytest.mark.parametrize("name", ["pinned-beam", "infinite-beam"])
def test_history(name, command_line, tmp_path):
    path = SCENES / f"{name}.json"
    command_line("simulate", path, "--out", tmp_path)
    found = vibroimpact.simulate(path, history=True)

    def check(file, columns):
        with open(tmp_path / file, newline="") as table:
            names, *rows = csv.reader(table)
        assert list(columns) == names
        written = np.array(rows, dtype=float)
        for place, column in enumerate(columns.values()):
            np.testing.assert_array_equal(column, written[:, place])

    check("history.csv", found["history"])
    if found["modal_energies"] is not None:
        energies = found["modal_energies"]["energy_j"]
        modes = {f"mode_{k + 1}_energy_j": energies[:, k] for k in range(energies.shape[1])}
        check("modal_energies.csv", {"time_s": found["modal_energies"]["time_s"], **modes})


@pytest.mark.parametrize("name", ["pinned-beam", "pinned-beam-small-ball", "infinite-beam"])
def test_plan_and_compare(name, command_line):
    path = SCENES / f"{name}.json"
    assert plain(vibroimpact.plan(path)) == command_line("plan", path)
    assert plain(vibroimpact.compare(path)) == command_line("compare", path)


@pytest.mark.parametrize(
    ("path", "by"),
    [
        (SCENES / "dropped-rod.json", ["structure.length_m", "striker.speed_m_s"]),
        (ASSEMBLIES / "shaken-table.json", ["gravity_m_s2"]),
    ],
)
def test_sensitivity(command_line, path, by):
    assert plain(vibroimpact.sensitivity(path, by)) == command_line("sensitivity", path, "--by", ",".join(by))


def test_a_model_without_a_history(scene, command_line, tmp_path):
    file = tmp_path / "scene.json"
    file.write_text(json.dumps(scene | {"model": "emoc"}))
    found = vibroimpact.simulate(file, history=True)
    assert found.pop("history") is None and found.pop("modal_energies") is None
    assert found["choice"]["model"] == "emoc" and found == command_line("simulate", file)


def test_modes(command_line):
    for name in ("stepped-cantilever.json", "stepped-shaft.toml"):
        assert plain(vibroimpact.modes(SCENES / name, 12)) == command_line("modes", SCENES / name, "--count", 12)


def test_infinite_beam(command_line):
    for s in (0.5, 15, 600):
        assert plain(vibroimpact.infinite_beam(s)) == command_line("infinite-beam", "--s", s)
    points = command_line("infinite-beam", "turning-points", "--count", 5)
    assert plain(vibroimpact.turning_points(5)) == points


def test_law(command_line):
    wanted = ("--restitution", 0.5, "--mass-kg", 0.2, "--speed-m-s", 1.5)
    assert plain(vibroimpact.law(0.5, 0.2, 1.5)) == command_line("law", *wanted)
    for_engine = vibroimpact.law(0.5, 0.2, 1.5, other_mass_kg=0.3, compression_m=0.01, step_s=0.001, law="mujoco")
    more = ("--other-mass-kg", 0.3, "--compression-m", 0.01, "--step-s", 0.001, "--law", "mujoco")
    assert plain(for_engine) == command_line("law", *wanted, *more)


def test_emoc(command_line):
    path = SCENES / "pinned-beam.json"
    assert vibroimpact.emoc(path) == command_line("emoc", path)
    options = ("--mu0", 0.5, "--alpha0", 8, "--alpha1", 0.3, "--emoc-modes", 50)
    assert vibroimpact.emoc(path, mu0=0.5, alpha0=8, alpha1=0.3, modes=50) == command_line("emoc", path, *options)


def test_fit(command_line, tmp_path):
    path = SCENES / "cantilever-tip.json"
    mass, place, restitution = OBSERVED = np.array(
        [[0.01, 0.1, 0.1, 0.5, 1.0], [0.3, 0.6, 1.0, 0.8, 0.45], [0.61, 0.32, 0.27, 0.41, 0.22]]
    )
    lines = ["mass_kg,location_m,restitution", *(",".join(map(str, row)) for row in OBSERVED.T)]
    (tmp_path / "observed.csv").write_text("\n".join(lines))
    expected = command_line("fit", tmp_path / "observed.csv", "--scene", path)
    assert plain(vibroimpact.fit(path, mass, place, restitution)) == expected


SWEEP = {
    "scene": json.loads((SCENES / "pinned-beam.json").read_text()),
    "vary": [
        {"field": "striker.speed_m_s", "from": 0.1, "to": 10, "count": 4, "scale": "log"},
        # The last location is beyond the beam, which gives a row too.
        {"field": "location_m", "values": [0.0, 0.31, 0.5, 7]},
        {"field": "contact.law", "values": ["hertz"]},
    ],
}


def test_sweep(command_line, tmp_path):
    path = tmp_path / "sweep.json"
    path.write_text(json.dumps(SWEEP))
    command_line("sweep", path, "--out", tmp_path / "out")
    with open(tmp_path / "out" / "results.csv", newline="") as table:
        rows = list(csv.DictReader(table))
    found = vibroimpact.sweep(path)
    assert list(found) == list(rows[0])
    assert {column.dtype.kind for column in found.values()} <= set("ifU")
    for name, column in found.items():
        written = [row[name] for row in rows]
        if column.dtype.kind == "U":
            assert column.tolist() == written
        else:
            np.testing.assert_array_equal(column, [float(cell) if cell else np.nan for cell in written])
    assert (found["error"] != "").tolist() == (found["location_m"] == 7).tolist()


FAULTS = [
    ("structure.segments[0].length_m", -1),
    ("structure.ends", ["pinned", "loose"]),
    ("structure.kind", "bem"),
    ("striker.speed_m_s", "fast"),
    ("location_m", 2),
    ("modes", 1e9),
    ("contact.poissons_ratio", 0.7),
    ("contact.law", "hooke"),
    ("color", "red"),
]


@pytest.mark.parametrize("field, value", FAULTS)
def test_errors(field, value, scene, command_line, tmp_path):
    *path, last = field.replace("[0]", ".0").split(".")
    entry = scene
    for name in path:
        entry = entry[int(name) if name.isdigit() else name]
    entry[last] = value
    file = tmp_path / "scene.json"
    file.write_text(json.dumps(scene))
    with pytest.raises(vibroimpact.InvalidInput) as found:
        vibroimpact.simulate(scene)
    assert str(found.value) == command_line("simulate", file)
    assert found.value.field and found.value.field in str(found.value)
    assert found.value.allowed and found.value.allowed in str(found.value)


def test_a_file_that_is_not_json(command_line, tmp_path):
    file = tmp_path / "scene.json"
    file.write_text('{ "striker": { "mass_kg": }')
    with pytest.raises(vibroimpact.InvalidInput) as found:
        vibroimpact.modes(file, 3)
    assert str(found.value) == command_line("modes", file, "--count", 3)
    with pytest.raises(FileNotFoundError) as missing:
        vibroimpact.simulate(tmp_path / "none.json")
    assert str(missing.value) == command_line("simulate", tmp_path / "none.json")


def test_sweeps_of_the_repository():
    for path in sorted((REPOSITORY / "datasets" / "sweeps").glob("speed*.json")):
        found = vibroimpact.sweep(path)
        assert (found["error"] == "").all()
