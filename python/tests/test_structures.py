"""Structures from other programs, compared with our own beam, and input that their readers reject."""

import json
import math

import numpy as np
import pytest
import vibroimpact
from conftest import REPOSITORY
from vibroimpact import structures

FILES = REPOSITORY / "datasets" / "structures"
POINTS = {"tip": 0.5, "middle": 0.25}
UP = (0, 0, 1)


def own_beam(location_m, theory="euler-bernoulli"):
    """The cantilever of the files."""
    return {
        "structure": {
            "kind": "beam", "ends": ["clamped", "free"], "theory": theory,
            "segments": [{"length_m": 0.5, "youngs_modulus_pa": 2.1e11, "poissons_ratio": 0.3, "density_kg_m3": 7850,
                          "width_m": 0.02, "thickness_m": 0.01}],
        },
        "striker": {"mass_kg": 0.05, "radius_m": 0.0115, "speed_m_s": 1},
        # The contact is soft, so that it lasts longer than a period of the highest listed modes.
        "contact": {"law": "hertz", "stiffness_n_m1_5": 1e7},
        "location_m": location_m,
    }


def own_modes(location_m, theory, count=3):
    found = vibroimpact.modes({**own_beam(location_m, theory), "modes": count}, count)
    return np.asarray(found["omega_rad_s"]), np.asarray(found["shape_at_location"])


def calculix():
    nodes = {"tip": 293, "middle": 149}
    folder = FILES / "calculix"
    return structures.from_calculix(
        folder / "cantilever.dat", folder / "cantilever.frd", {name: (node, UP) for name, node in nodes.items()},
        {name: folder / f"cantilever-{name}.frd" for name in nodes},
    )


def nastran():
    pytest.importorskip("pyNastran")
    grids = {"tip": 21, "middle": 11}
    folder = FILES / "nastran"
    return structures.from_nastran(
        folder / "cantilever.op2", {name: (grid, UP) for name, grid in grids.items()},
        {name: folder / f"cantilever-{name}.op2" for name in grids},
    )


def matrices():
    pytest.importorskip("scipy")
    folder = FILES / "matrices"
    return structures.from_matrices(folder / "stiffness.mtx", folder / "mass.mtx", {"tip": 78, "middle": 38}, 8)


def universal():
    pytest.importorskip("pyuff")
    return structures.from_universal(FILES / "universal" / "cantilever.uff", {"tip": (2, 3), "middle": (1, 3)}, "tip", 3)


# The theory of our beam, and the largest relative errors of three frequencies, of shapes relative to the largest, and of
# compliances. Solids bend by Timoshenko's theory, and their clamp also prevents lateral contraction; MYSTRAN's bars have their mass
# in twenty nodes; the error of Hermite elements follows from their length; the responses are noisy.
@pytest.mark.parametrize(
    ("reader", "theory", "errors"),
    [
        (calculix, "timoshenko", (0.01, 0.02, 0.02)),
        (nastran, "euler-bernoulli", (0.01, 0.02, 0.001)),
        (matrices, "euler-bernoulli", (1e-5, 1e-4, 1e-6)),
        (universal, "euler-bernoulli", (1e-4, 0.002, 0.002)),
    ],
)
def test_readers_agree_with_our_own_beam(reader, theory, errors, tmp_path):
    structure = reader()
    signs = np.sign(structure.shapes["tip"][:3]) * np.sign(own_modes(0.5, theory)[1])
    for name, place in POINTS.items():
        omega, shape = own_modes(place, theory)
        assert np.abs(structure.omega_rad_s[:3] / omega - 1).max() < errors[0]
        assert np.abs(structure.shapes[name][:3] * signs - shape).max() < errors[1] * 2.26
    bending, length = 2.1e11 * 0.02 * 0.01**3 / 12, 0.5
    exact = {"tip": length**3 / (3 * bending), "middle": (length / 2) ** 3 / (3 * bending)}
    for name, compliance in structure.static_compliances_m_n.items():
        assert compliance == pytest.approx(exact[name], rel=errors[2])
    assert "tip" in structure.static_compliances_m_n

    # An impact on the table, with remainder modes for the modes that it does not list, and one on our beam with all its modes.
    scene = own_beam(0.5) | {"structure": structure.write(tmp_path / "modes.csv"), "location": "tip"}
    del scene["location_m"]
    scene["residual_compliance"] = True
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    read = vibroimpact.simulate(tmp_path / "scene.json")
    ours = vibroimpact.simulate(own_beam(0.5, theory) | {"tolerance": 1e-4})
    assert read["remainder_modes"] > 0
    assert read["restitution"] == pytest.approx(ours["restitution"], abs=0.005)
    # The same numbers within the scene.
    inside = vibroimpact.simulate(scene | {"structure": structure.modal()})
    assert inside["restitution"] == read["restitution"]


def test_a_free_structure_has_the_compliance_of_its_elastic_modes():
    pytest.importorskip("scipy")
    # Three masses in a row on two springs: the modes are known.
    k, m = 1e5, 0.5
    stiffness = k * np.array([[1.0, -1, 0], [-1, 2, -1], [0, -1, 1]])
    found = structures.from_matrices(stiffness, m * np.eye(3), {"end": 0}, 2)
    assert found.omega_rad_s[0] == 0.0
    assert found.omega_rad_s[1] == pytest.approx(math.sqrt(k / m), rel=1e-10)
    # Elastic modes (1, 0, -1)/sqrt 2 and (1, -2, 1)/sqrt 6 with k/m and 3 k/m.
    exact = 0.5 / k + (1 / 6) / (3 * k)
    assert found.static_compliances_m_n["end"] == pytest.approx(exact, rel=1e-10)


def test_units_of_a_model_are_converted_to_si():
    pytest.importorskip("scipy")
    # One mass on a spring, in millimetres and tonnes: N/mm and t.
    pair = structures.from_matrices(
        np.array([[2.0, -1], [-1, 2.0]]), 1e-3 * np.eye(2), {"p": 0}, 1, length_m=1e-3, mass_kg=1e3
    )
    same = structures.from_matrices(
        1e3 * np.array([[2.0, -1], [-1, 2.0]]), np.eye(2), {"p": 0}, 1
    )
    assert pair.omega_rad_s == pytest.approx(same.omega_rad_s)
    assert np.abs(pair.shapes["p"]) == pytest.approx(np.abs(same.shapes["p"]))
    assert pair.static_compliances_m_n["p"] == pytest.approx(same.static_compliances_m_n["p"])


def test_measured_modes_have_their_uncertainty(tmp_path):
    table = tmp_path / "test.csv"
    table.write_text(
        "frequency_hz,frequency_hz_sd,damping_ratio,damping_ratio_sd,tip,tip_sd,middle\n"
        "33.4,0.05,0.004,0.0005,2.26,0.03,0.77\n209.4,0.3,0.005,0.0005,-2.26,0.03,1.61\n"
    )
    structure = structures.from_table(table, {"tip": 1.19e-4})
    uncertain = structure.uncertain("tip")
    assert uncertain["structure.omega_rad_s[1]"]["normal"] == pytest.approx([2 * math.pi * 209.4, 2 * math.pi * 0.3])
    assert uncertain["structure.points.tip.shape[1]"]["normal"] == [-2.26, 0.03]
    assert len(uncertain) == 6
    scene = own_beam(0.5) | {"location": "tip"}
    del scene["location_m"]
    structure.write_sweep(tmp_path / "sweep.json", scene)
    sweep = json.loads((tmp_path / "sweep.json").read_text())
    assert sweep["uncertain"] == uncertain
    assert 0 < vibroimpact.simulate(sweep["scene"])["restitution"] < 1


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("frequency_hz,tip\n", "a line for each mode"),
        ("tip\n1\n", "one column of frequencies"),
        ("frequency_hz,omega_rad_s,tip\n1,1,1\n", "one column of frequencies"),
        ("frequency_hz,tip\n1,x\n", "row 2, tip = 'x'"),
        ("frequency_hz,tip\n1\n", "row 2 has 1 cells"),
        ("frequency_hz,tip,tip\n1,1,1\n", "a name of its own"),
        ("frequency_hz,tip,end_sd\n1,1,1\n", "column end_sd"),
        ("frequency_hz,tip,tip_sd\n1,1,-1\n", "column tip_sd = -1.0"),
        ("frequency_hz,tip\n-1,1\n", "omega_rad_s = -6.28"),
        ("frequency_hz\n1\n", "at least one named point"),
    ],
)
def test_tables_that_cannot_be_used_are_refused_by_name(text, told, tmp_path):
    (tmp_path / "test.csv").write_text(text)
    with pytest.raises(ValueError, match=told.replace("(", r"\(")):
        structures.from_table(tmp_path / "test.csv")


def test_missing_content_of_a_file_is_reported():
    folder = FILES / "calculix"
    files = (folder / "cantilever.dat", folder / "cantilever.frd")
    with pytest.raises(ValueError, match="node 7 is not in"):
        structures.from_calculix(*files, {"tip": (7, UP)})
    with pytest.raises(ValueError, match="direction of tip"):
        structures.from_calculix(*files, {"tip": (293, (0, 0, 0))})
    with pytest.raises(ValueError, match="no eigenvalues"):
        structures.from_calculix(files[1], files[1], {"tip": (293, UP)})
    with pytest.raises(ValueError, match="one of the points"):
        structures.from_calculix(*files, {"tip": (293, UP)}, {"end": files[1]})
    with pytest.raises(ValueError, match="static compliance of 'end'"):
        structures.Structure(np.ones(1), {"tip": np.ones(1)}, static_compliances_m_n={"end": 1.0})
    with pytest.raises(ValueError, match="mass_kg = 0"):
        structures.from_calculix(*files, {"tip": (293, UP)}, mass_kg=0)


def test_unsolvable_or_unreadable_input_is_reported():
    pytest.importorskip("scipy")
    eye = np.eye(3)
    with pytest.raises(ValueError, match="count = 3"):
        structures.from_matrices(eye, eye, {"p": 0}, 3)
    with pytest.raises(ValueError, match="symmetric"):
        structures.from_matrices(np.triu(np.ones((3, 3))), eye, {"p": 0}, 1)
    with pytest.raises(ValueError, match="point p = 3"):
        structures.from_matrices(eye, eye, {"p": 3}, 1)
    with pytest.raises(ValueError, match="unstable"):
        structures.from_matrices(np.diag([-1.0, 1, 2]), eye, {"p": 0}, 2)
    pytest.importorskip("pyuff")
    file = FILES / "universal" / "cantilever.uff"
    with pytest.raises(ValueError, match="contains no response"):
        structures.from_universal(file, {"tip": (2, 3), "other": (9, 3)}, "tip", 3)
    with pytest.raises(ValueError, match="driving = 'end'"):
        structures.from_universal(file, {"tip": (2, 3)}, "end", 3)
    with pytest.raises(ValueError, match="too few"):
        structures.from_universal(file, {"tip": (2, 3)}, "tip", 3, band_hz=(1, 10))
    pytest.importorskip("pyNastran")
    folder = FILES / "nastran"
    with pytest.raises(ValueError, match="grid point 99"):
        structures.from_nastran(folder / "cantilever.op2", {"tip": (99, UP)})
    with pytest.raises(ValueError, match="no eigenvectors"):
        structures.from_nastran(folder / "cantilever-tip.op2", {"tip": (21, UP)})
