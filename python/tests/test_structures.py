"""Structures from other programs, compared with our own beam, and input that their readers reject."""

import gzip
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
        modal_masses=1.0,
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
    found = structures.from_matrices(stiffness, m * np.eye(3), {"end": 0}, 2, rigid_modes=1)
    assert found.omega_rad_s[0] == 0.0
    assert found.omega_rad_s[1] == pytest.approx(math.sqrt(k / m), rel=1e-10)
    # Elastic modes (1, 0, -1)/sqrt 2 and (1, -2, 1)/sqrt 6 with k/m and 3 k/m.
    exact = 0.5 / k + (1 / 6) / (3 * k)
    assert found.static_compliances_m_n["end"] == pytest.approx(exact, rel=1e-10)


def hermite_beam(elements, fixed):
    """The cantilever of the files, or the same beam without its clamp, by Hermite's cubic elements."""
    h = 0.5 / elements
    bending, mass = 2.1e11 * 0.02 * 0.01**3 / 12, 7850 * 0.02 * 0.01
    stiffness = bending / h**3 * np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
    inertia = mass * h / 420 * np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]])
    scale = np.array([1.0, h, 1.0, h])
    k, m = (np.zeros((2 * elements + 2, 2 * elements + 2)) for _ in range(2))
    for e in range(elements):
        here = slice(2 * e, 2 * e + 4)
        k[here, here] += scale[:, None] * stiffness * scale
        m[here, here] += scale[:, None] * inertia * scale
    first = 2 if fixed else 0
    return k[first:, first:], m[first:, first:]


def test_rigid_body_modes_are_told_by_the_rounding_of_the_matrices():
    pytest.importorskip("scipy")
    # The 60th eigenvalue is 1.5e8 times the first, which is elastic all the same.
    folder = FILES / "matrices"
    many = structures.from_matrices(folder / "stiffness.mtx", folder / "mass.mtx", {"tip": 78}, 60)
    assert many.omega_rad_s[0] == pytest.approx(209.988, rel=1e-5)
    assert many.static_compliances_m_n["tip"] == pytest.approx(0.5**3 / (3 * 350), rel=1e-9)
    # Fine meshes, clamped and free; of the free beam the elastic compliance at its end is l^3/(105 EI).
    for elements in (40, 600):
        k, m = hermite_beam(elements, fixed=True)
        clamped = structures.from_matrices(k, m, {"tip": len(k) - 2}, 6)
        assert clamped.omega_rad_s[0] == pytest.approx(209.988, rel=1e-5)
        assert clamped.static_compliances_m_n["tip"] == pytest.approx(0.5**3 / (3 * 350), rel=1e-4)
        k, m = hermite_beam(elements, fixed=False)
        free = structures.from_matrices(k, m, {"end": 0}, 6, rigid_modes=2)
        assert list(free.omega_rad_s[:2]) == [0, 0]
        assert free.omega_rad_s[2] == pytest.approx(1336.21, rel=1e-5)
        assert free.static_compliances_m_n["end"] == pytest.approx(0.5**3 / (105 * 350), rel=1e-4)
    # Entries with five digits: the rigid-body modes are lost in their rounding, unless that is stated.
    rounded = np.vectorize(lambda value: float(f"{value:.4e}"))
    k, m = (rounded(matrix) for matrix in hermite_beam(7, fixed=False))
    told = structures.from_matrices(k, m, {"end": 0}, 6, rigid_modes=2, rounding=1e-5)
    assert list(told.omega_rad_s[:2]) == [0, 0] and told.omega_rad_s[2] == pytest.approx(1336.2, rel=1e-2)
    with pytest.raises(ValueError, match="rigid_modes = 2 is not allowed; it must be from 0 to 1, less than the count"):
        structures.from_matrices(k, m, {"end": 0}, 2, rigid_modes=2, rounding=1e-5)
    for stated in (0, 1, 3):
        with pytest.raises(ValueError, match=f"rigid_modes = {stated} is not allowed; it must be 2, the number of eigenvalues"):
            structures.from_matrices(k, m, {"end": 0}, 6, rigid_modes=stated, rounding=1e-5)
    with pytest.raises(ValueError, match="rounding = 0"):
        structures.from_matrices(k, m, {"end": 0}, 2, rounding=0)


def test_rigid_body_modes_of_a_program_are_told_by_a_gap():
    from vibroimpact.structures._structure import frequencies

    # CalculiX's eigenvalues of the free beam, with their rounding of either sign.
    rigid = [-0.9765535e-04, -0.5620750e-04, -0.3033299e-04, -0.1109988e-04, 0.3413387e-04, 0.1806336e-03]
    found = frequencies("free.dat", np.array([*rigid, 0.1781657e07, 0.7066366e07]))
    assert list(found[:6]) == [0] * 6 and found[6] == pytest.approx(1334.787, rel=1e-6)
    # A hundred modes of a cantilever, whose eigenvalues grow with the fourth power.
    many = (math.pi * (np.arange(1, 101) - 0.5)) ** 4
    assert frequencies("many.dat", many)[0] == pytest.approx(math.sqrt(many[0]))
    # A beam on soft strings, 1 Hz below 300 Hz.
    hung = (2 * math.pi * np.array([1.0, 1.5, 300, 800])) ** 2
    assert frequencies("hung.dat", hung) == pytest.approx(np.sqrt(hung))
    # A structure that carries a static load has no rigid-body modes.
    assert frequencies("soft.dat", np.array([1e-4, 1e6]), supported=True)[0] == pytest.approx(0.01)
    with pytest.raises(ValueError, match="the eigenvalue -400.0 is not allowed"):
        frequencies("buckled.dat", np.array([-400.0, 5e4, 1e6]))


def test_a_preload_is_not_taken_for_a_mode(tmp_path):
    # The files of a job with a static step before that of the modes.
    folder = FILES / "calculix"
    static = (folder / "cantilever-tip.frd").read_text()
    modes = (folder / "cantilever.frd").read_text()
    first, end = static.index("    1PSTEP"), static.rindex(" 9999")
    place = modes.index("    1PSTEP")
    preloaded = tmp_path / "preloaded.frd"
    preloaded.write_text(modes[:place] + static[first:end] + modes[place:])
    points = {"tip": (293, UP), "middle": (149, UP)}
    found = structures.from_calculix(folder / "cantilever.dat", preloaded, points)
    assert np.array_equal(found.shapes["tip"], calculix().shapes["tip"])
    # Static displacements of several steps are not those of the load alone, and modes are no static displacements.
    several = tmp_path / "several.frd"
    several.write_text(static[:end] + static[first:])
    for file, count in ((several, 2), (folder / "cantilever.frd", 0)):
        with pytest.raises(ValueError, match=f"contains {count} static displacements"):
            structures.from_calculix(folder / "cantilever.dat", preloaded, points, {"tip": file})
    with pytest.raises(ValueError, match="contains 0 shapes"):
        structures.from_calculix(folder / "cantilever.dat", folder / "cantilever-tip.frd", points)


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
    # Lognormal distributions, which have no negative numbers, of the measured mean and standard deviation.
    for field, mean, sd in [
        ("omega_rad_s[1]", 2 * math.pi * 209.4, 2 * math.pi * 0.3),
        ("damping_ratios[0]", 0.004, 0.0005),
    ]:
        median, log_sd = uncertain[f"structure.{field}"]["lognormal"]
        assert median * math.exp(log_sd**2 / 2) == pytest.approx(mean, rel=1e-12)
        assert mean * math.sqrt(math.expm1(log_sd**2)) == pytest.approx(sd, rel=1e-12)
    assert uncertain["structure.points.tip.shape[1]"]["normal"] == [-2.26, 0.03]
    assert len(uncertain) == 6
    scene = own_beam(0.5) | {"location": "tip"}
    del scene["location_m"]
    structure.write_sweep(tmp_path / "sweep.json", scene)
    sweep = json.loads((tmp_path / "sweep.json").read_text())
    assert sweep["uncertain"] == uncertain
    # The compliance of the modes that are not listed is fixed, and the static one varies with the listed modes.
    (point,) = (point for name, point in sweep["scene"]["structure"]["points"].items() if name == "tip")
    listed = (2.26 / (2 * math.pi * 33.4)) ** 2 + (2.26 / (2 * math.pi * 209.4)) ** 2
    assert point["residual_compliance_m_n"] == pytest.approx(1.19e-4 - listed) and "static_compliance_m_n" not in point
    assert 0 < vibroimpact.simulate(sweep["scene"])["restitution"] < 1
    found = vibroimpact.sweep(sweep | {"sampling": {"draws": 64}})
    assert set(found["error"]) == {""}
    with pytest.raises(ValueError, match="static compliance of tip = 0.0001 is not allowed; it must be not less than"):
        structures.from_table(table, {"tip": 1e-4}).write_sweep(tmp_path / "less.json", scene)
    with pytest.raises(ValueError, match="location = 'end'"):
        structure.uncertain("end")
    with pytest.raises(ValueError, match="standard_deviations are missing"):
        matrices().write_sweep(tmp_path / "exact.json", scene)
    structure.damping_ratios[0] = 0
    with pytest.raises(ValueError, match=r"damping_ratios\[0\] = 0.0 with the standard deviation 0.0005"):
        structure.uncertain()


def test_a_sweep_takes_many_measured_modes(tmp_path):
    # Damping ratios with large standard deviations, of which a normal distribution has negative draws.
    rows = "".join(f"{30.0 * k**2},{0.3 * k},0.004,0.003,{2 * (-1) ** k},0.05\n" for k in range(1, 11))
    (tmp_path / "test.csv").write_text("frequency_hz,frequency_hz_sd,damping_ratio,damping_ratio_sd,tip,tip_sd\n" + rows)
    structure = structures.from_table(tmp_path / "test.csv", {"tip": 1.3e-4})
    scene = own_beam(0.5) | {"location": "tip"}
    del scene["location_m"]
    structure.write_sweep(tmp_path / "sweep.json", scene)
    sweep = json.loads((tmp_path / "sweep.json").read_text()) | {"sampling": {"draws": 256}}
    assert len(sweep["uncertain"]) == 30
    found = vibroimpact.sweep(sweep)
    assert len(found["error"]) == 256 and set(found["error"]) == {""}


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
        ("frequency_hz,modal_mass_kg\n1,1\n", "at least one named point"),
        ("frequency_hz,modal_mass_kg,tip\n1,0,1\n", "column modal_mass_kg = 0.0 is not allowed; it must be a positive number"),
        ("frequency_hz,modal_mass_kg,tip\n1,nan,1\n", "row 2, modal_mass_kg = 'nan'"),
        ("frequency_hz,modal_mass_kg_sd,tip\n1,1,1\n", "column modal_mass_kg_sd is not allowed; it must be beside"),
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
    with pytest.raises(ValueError, match="stiffness is not allowed; it must be without negative eigenvalues"):
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
        structures.from_nastran(folder / "cantilever.op2", {"tip": (99, UP)}, modal_masses=1.0)
    with pytest.raises(ValueError, match="no eigenvectors"):
        structures.from_nastran(folder / "cantilever-tip.op2", {"tip": (21, UP)})


def test_masses_and_damping_that_no_structure_has_are_refused():
    pytest.importorskip("scipy")
    k = np.array([[2.0, -1.0], [-1.0, 1.0]])
    with pytest.raises(ValueError, match="mass is not allowed; it must be without negative eigenvalues"):
        structures.from_matrices(k, -np.eye(2), {"tip": 1}, 1)
    with pytest.raises(ValueError, match="count = 1 is not allowed; it must be a number of modes that stiffness and mass have"):
        structures.from_matrices(k, np.diag([1.0, 0.0]), {"tip": 1}, 1)
    with pytest.raises(ValueError, match=r"damping_ratios = -1.0 is not allowed; it must be 0 or a positive number"):
        structures.from_matrices(k, np.eye(2), {"tip": 1}, 1, damping_ratios=-1)


# A hammer test of two points, with two modes in the band and one above it.
OMEGA = 2 * math.pi * np.array([30.0, 110.0, 420.0])
DAMPING = np.array([0.01, 0.006, 0.008])
SHAPES = {"tip": np.array([1.2, 0.8, 1.1]), "end": np.array([0.5, -0.9, 0.7])}
PLACES = {"tip": (7, 3), "end": (4, 2)}
EVEN = 1.0 + 0.25 * np.arange(800)


def function_58(response="end", force="tip", kind=12, lines=EVEN, even=True, scale=1.0, signs=(1, 1), cut=0, rigid=0.0, **fields):
    """A frequency response of this test as data set 58, in double precision, without the help of pyuff."""
    omega = 2 * math.pi * lines
    pole_terms = OMEGA**2 - omega[:, None] ** 2 + 2j * DAMPING * OMEGA * omega[:, None]
    receptance = (SHAPES[response] * SHAPES[force] / pole_terms).sum(axis=1) - rigid / omega**2
    values = scale * signs[0] * signs[1] * receptance * (1j * omega) ** {8: 0, 11: 1}.get(kind, 2)
    stated = {"function": 4, "load": 0, "data": 6, "count": len(lines), "abscissa": 18, "denominator": 13, "label": "NONE"} | fields
    (node, axis), (at, along) = PLACES[response], PLACES[force]
    first, spacing = (lines[0], lines[1] - lines[0]) if even else (0.0, 0.0)
    head = [
        "    -1", "    58", *["NONE"] * 5,
        f"{stated['function']:5d}{0:10d}{0:5d}{stated['load']:10d} {'NONE':10s}{node:10d}{signs[0] * axis:4d}"
        f" {'NONE':10s}{at:10d}{signs[1] * along:4d}",
        f"{stated['data']:10d}{stated['count']:10d}{int(even):10d}{first:13.5e}{spacing:13.5e}{0:13.5e}",
        *(
            f"{number:10d}{0:5d}{0:5d}{0:5d} {'NONE':20s} {label:20s}"
            for number, label in ((stated["abscissa"], "Hz"), (kind, stated["label"]), (stated["denominator"], "NONE"), (0, "NONE"))
        ),
    ]
    if even:
        numbers = [f"{part:20.12e}" for value in values for part in (value.real, value.imag)]
        body = ["".join(numbers[k : k + 4]) for k in range(0, len(numbers), 4)]
    else:
        body = [f"{x:13.5e}{value.real:20.12e}{value.imag:20.12e}" for x, value in zip(lines, values, strict=True)]
    return "\n".join([*head, *(body[:-cut] if cut else body), "    -1", ""])


def units_164(code, length, force):
    """The data set of units: numbers of the file are those in SI times the factors."""
    factors = f"{length:25.16e}{force:25.16e}{1:25.16e}\n{0:25.16e}".replace("e", "D")
    return f"    -1\n   164\n{code:10d}{'units':20s}{1:10d}\n{factors}\n    -1\n"


def assert_is_the_test(path):
    found = structures.from_universal(path, PLACES, "tip", 2)
    assert found.omega_rad_s == pytest.approx(OMEGA[:2], rel=1e-5)
    assert found.damping_ratios == pytest.approx(DAMPING[:2], rel=1e-3)
    for name, shape in SHAPES.items():
        assert found.shapes[name] == pytest.approx(shape[:2], rel=1e-3)
    exact = float((SHAPES["tip"] ** 2 / OMEGA**2).sum())
    assert found.static_compliances_m_n["tip"] == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize(
    "text",
    [
        # The hammer stays, or roves while the accelerometer stays; displacement, velocity or acceleration over force.
        function_58("tip") + function_58("end", "tip"),
        function_58("tip", kind=8) + function_58("tip", "end", kind=11),
        function_58("tip", signs=(-1, 1)) + function_58("tip", "end", signs=(1, -1)),
        # Both, among others that are not needed.
        function_58("end", "end", denominator=0) + function_58("tip") + function_58("end") + function_58("tip", "end", function=6),
        # Inch and pound, millimetre and millinewton, units of the user.
        units_164(7, 39.37008, 0.2248089) + "".join(function_58(p, scale=39.37008 / 0.2248089, label="in/s^2") for p in PLACES),
        units_164(5, 1e3, 1e3) + "".join(function_58(p, label="mm/s^2/mN") for p in PLACES),
        units_164(9, 100.0, 1e-3) + "".join(function_58(p, scale=1e5) for p in PLACES),
        # Uneven lines: closer around the first mode, and of one ratio.
        "".join(
            function_58(p, lines=np.sort(np.concatenate([np.arange(1.0, 200.0, 0.5), np.arange(29.01, 31.0, 0.04)])), even=False)
            for p in PLACES
        ),
        "".join(function_58(p, lines=np.array([float(f"{x:.5e}") for x in np.geomspace(3, 200, 1500)]), even=False) for p in PLACES),
    ],
)
def test_a_hammer_test_is_read_in_each_of_its_forms(text, tmp_path):
    pytest.importorskip("pyuff")
    (tmp_path / "test.uff").write_text(text)
    assert_is_the_test(tmp_path / "test.uff")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (function_58("tip") + function_58(cut=30), "data set 2: number of values = 740 is not allowed; it must be 800"),
        (function_58("tip") + function_58()[:-4000], "is not a whole universal file"),
        (function_58("tip")[:-7] + function_58(), "is not a whole universal file: it has 3 lines -1"),
        (function_58("tip")[:-7] + function_58() + function_58("end", "end")[:-7], "data set 2: type = none"),
        (function_58("tip") + function_58(count=801), "data set 2: number of values = 800 is not allowed; it must be 801"),
        (function_58("tip") + function_58(denominator=12), "data set 2: kind of the denominator = 12 .* 13: excitation force"),
        (function_58("tip") + function_58(denominator=0), "data set 2: kind of the denominator = 0"),
        (function_58("tip", kind=13) + function_58(), "data set 1: kind of the ordinate = 13 .* 8, 11 or 12"),
        (function_58("tip") + function_58(abscissa=19), "data set 2: kind of the abscissa = 19 .* 18: frequency"),
        (function_58("tip") + function_58(load=2), "data set 2: load case = 2"),
        (function_58("tip") + function_58(data=4, count=1600), "data set 2: data type of the ordinate = 4 .* complex"),
        (function_58("tip") + function_58() + function_58(), "data set 3: a response of .* the only one, and data set 2 is one"),
        (function_58("tip") + function_58(function=3), r"contains no response of \['end'\] to a force at tip, nor the reverse"),
        (function_58("tip") + function_58(lines=EVEN + 0.1), "data sets 1 and 2 have different frequencies"),
        (function_58("tip", lines=EVEN[::-1], even=False) + function_58(), "data set 1: frequencies = not ascending"),
        (function_58("tip", label="g/N") + function_58(), "data set 1: unit of the ordinate = 'g/N' .* SI"),
        (units_164(5, 1e3, 1e3) + function_58("tip", label="m/s^2") + function_58(), "data set 2: unit of the ordinate = 'm/s\\^2'"),
        (units_164(1, 3.28, 0.2248) + function_58("tip") + function_58(), "data set 1: factors of length and force .* code of units 1"),
        (units_164(9, 0.0, 1.0) + function_58("tip") + function_58(), "data set 1: factors .* positive"),
        (function_58("tip") + units_164(5, 1e3, 1e3) + function_58(), "data set 2: place of the units"),
        (units_164(1, 1, 1) + units_164(5, 1e3, 1e3) + function_58("tip") + function_58(), "data set 2: factors .* before it"),
    ],
)
def test_a_hammer_test_that_cannot_be_read_is_refused_by_name(text, told, tmp_path):
    pytest.importorskip("pyuff")
    (tmp_path / "test.uff").write_text(text)
    with pytest.raises(ValueError, match=f"test.uff.*{told}"):
        structures.from_universal(tmp_path / "test.uff", PLACES, "tip", 2)


def test_motion_below_the_band_is_that_of_a_free_structure_or_refused(tmp_path):
    pytest.importorskip("pyuff")
    file = tmp_path / "test.uff"
    # The rigid-body motion of a structure of 2 kg.
    file.write_text(function_58("tip", rigid=0.5) + function_58("end", rigid=0.5))
    with pytest.raises(ValueError, match="the response at tip shows motion below 1 Hz, .* or state free=True"):
        structures.from_universal(file, PLACES, "tip", 2)
    found = structures.from_universal(file, PLACES, "tip", 2, free=True)
    assert found.static_compliances_m_n["tip"] == pytest.approx(float((SHAPES["tip"] ** 2 / OMEGA**2).sum()), rel=1e-3)
    # The lowest mode is below the band. Whether it is just seen or just not excluded depends on rounding.
    told = "(shows|does not exclude)"
    file.write_text(function_58("tip") + function_58("end"))
    with pytest.raises(ValueError, match=f"the response at tip {told} motion below 60 Hz, .* begin below the lowest mode"):
        structures.from_universal(file, PLACES, "tip", 1, band_hz=(60, 200))


def test_modes_that_do_not_describe_a_hammer_test_are_refused(tmp_path):
    pytest.importorskip("pyuff")
    file = tmp_path / "test.uff"
    file.write_text(function_58("tip") + function_58())
    with pytest.raises(ValueError, match="the responses show more than 1 modes, such as one near (30|110) Hz"):
        structures.from_universal(file, PLACES, "tip", 1)
    with pytest.raises(ValueError, match="point end = .* a direction, 1, 2 or 3"):
        structures.from_universal(file, PLACES | {"end": (4, 6)}, "tip", 2)
    with pytest.raises(ValueError, match="the band cuts through the resonance at 1.* Hz"):
        structures.from_universal(file, PLACES, "tip", 2, band_hz=(1, 110.3))
    # A sensor that changes during the test.
    noisy = np.random.default_rng(1)
    text = function_58()
    head, body = text.split("\n")[:13], text.split("\n")[13:-2]
    rows = [np.array([float(row[20 * k : 20 * k + 20]) for k in range(4)]) for row in body]
    drift = np.repeat(1 + 0.5 * noisy.standard_normal(len(rows) // 20), 20)
    body = ["".join(f"{value:20.12e}" for value in share * row) for share, row in zip(drift, rows, strict=True)]
    file.write_text(function_58("tip") + "\n".join([*head, *body, "    -1", ""]))
    with pytest.raises(ValueError, match="2 modes do not describe the responses: the misfit is"):
        structures.from_universal(file, PLACES, "tip", 2)


TIP = {"tip": (21, UP)}


class Op2:
    """The records of an .op2 file with results, which are changed here as other jobs would write them."""

    def __init__(self, name):
        content, self.records = (FILES / "nastran" / name).read_bytes(), []
        while content:
            length = int.from_bytes(content[:4], "little")
            self.records.append(content[4 : 4 + length])
            content = content[8 + length :]
        # The label of the tape, then tables that begin with their name and end with three marks, and the end of the file.
        self.label, self.tables = self.records[:8], self.records[8:-1]

    def changed(self, subcase=1, factor=1.0):
        """The tables as those of another subcase with other displacements."""
        tables = []
        for record in self.tables:
            if len(record) == 584:
                record = record[:12] + subcase.to_bytes(4, "little") + record[16:]
            elif len(record) == 672:
                # 21 grid points: identity, kind, three translations and three rotations
                rows = np.frombuffer(record, dtype="<f4").reshape(-1, 8).copy()
                rows[:, 2:] *= factor
                record = rows.tobytes()
            tables.append(record)
        return tables

    def eigenvalues(self, masses):
        """Nastran's table of eigenvalues, which MYSTRAN does not write."""
        heads = [record for record in self.tables if len(record) == 584]
        values = [float(np.frombuffer(head, dtype="<f4")[5]) for head in heads]
        rows = b"".join(
            np.array([k, k], dtype="<i4").tobytes()
            + np.array([value, value**0.5, value**0.5 / (2 * math.pi), mass, mass * value], dtype="<f4").tobytes()
            for k, (value, mass) in enumerate(zip(values, masses, strict=True), start=1)
        )
        head = np.zeros(146, dtype="<i4")
        # real eigenvalues (6) of the approach of modes (2)
        head[:2], head[3], head[9] = (21, 6), 1, 7
        # title, subtitle and label: blanks
        head[50:] = 0x20202020
        content = [b"LAMA    ", -1, 7, bytes(28), -2, 1, 0, 7, bytes(28), -3, 1, 0, 146, head.tobytes(), -4, 1, 0, len(rows) // 4, rows]
        marks = [2, *content, -5, 1, 0, 0]
        return [mark if isinstance(mark, bytes) else mark.to_bytes(4, "little", signed=True) for mark in marks]

    def write(self, path, *tables):
        written = [*self.label, *(record for table in tables for record in table), self.records[-1]]
        path.write_bytes(b"".join(len(r).to_bytes(4, "little") + r + len(r).to_bytes(4, "little") for r in written))
        return path


def test_shapes_of_nastran_are_scaled_by_their_generalised_masses(tmp_path):
    pytest.importorskip("pyNastran")
    modes, exact = Op2("cantilever.op2"), nastran()
    # Shapes of the largest displacement 1, as by NORM=MAX: their generalised mass is that of the factors, squared.
    factor = 0.37
    masses = [factor**2] * 8
    file = modes.write(tmp_path / "modes.op2", modes.eigenvalues(masses), modes.changed(factor=factor))
    assert structures.from_nastran(file, TIP).shapes["tip"] == pytest.approx(exact.shapes["tip"], rel=1e-5)
    with pytest.raises(ValueError, match="modal_masses = 1.0 is not allowed; it must be left out"):
        structures.from_nastran(file, TIP, modal_masses=1.0)
    # The table is missing, or is that of other modes.
    other = [record.replace(np.float32(4.39940742e04).tobytes(), np.float32(5e4).tobytes()) for record in modes.eigenvalues(masses)]
    for tables in ([], other):
        file = modes.write(tmp_path / "modes.op2", tables, modes.changed(factor=factor))
        with pytest.raises(ValueError, match="modes.op2 contains no table of eigenvalues .* state modal_masses, 1 if"):
            structures.from_nastran(file, TIP)
        found = structures.from_nastran(file, TIP, modal_masses=masses)
        assert found.shapes["tip"] == pytest.approx(exact.shapes["tip"], rel=1e-5)
    for wrong, told in (([1.0], "modal_masses = 1 numbers"), (0.0, "modal_masses = 0.0")):
        with pytest.raises(ValueError, match=told):
            structures.from_nastran(file, TIP, modal_masses=wrong)
    file = modes.write(tmp_path / "modes.op2", modes.eigenvalues([0.0] * 8), modes.changed())
    with pytest.raises(ValueError, match="modes.op2: generalised mass = 0.0"):
        structures.from_nastran(file, TIP)


def test_subcases_of_nastran_are_chosen_by_name(tmp_path):
    pytest.importorskip("pyNastran")
    modes, static, exact = Op2("cantilever.op2"), Op2("cantilever-tip.op2"), nastran()
    two_modes = modes.write(tmp_path / "modes.op2", modes.changed(subcase=3, factor=2.0), modes.changed(subcase=4))
    two_loads = static.write(tmp_path / "static.op2", static.changed(subcase=1, factor=2.5), static.changed(subcase=2))
    with pytest.raises(ValueError, match=r"modes.op2 contains 2 results, of the subcases \['3.*'4.*state one by subcase=NUMBER"):
        structures.from_nastran(two_modes, TIP, modal_masses=1.0)
    with pytest.raises(ValueError, match=r"subcase = 1 is not allowed; it must be one of \[3, 4\]"):
        structures.from_nastran(two_modes, TIP, subcase=1, modal_masses=1.0)
    with pytest.raises(ValueError, match="static.op2 contains 2 results, .*state one by static={'tip': "):
        structures.from_nastran(two_modes, TIP, {"tip": two_loads}, subcase=4, modal_masses=1.0)
    found = structures.from_nastran(two_modes, TIP, {"tip": (two_loads, 2)}, subcase=4, modal_masses=1.0)
    assert np.array_equal(found.shapes["tip"], exact.shapes["tip"])
    assert found.static_compliances_m_n["tip"] == exact.static_compliances_m_n["tip"]


def test_files_of_nastran_that_are_cut_off_or_not_loaded_are_refused(tmp_path):
    pytest.importorskip("pyNastran")
    modes, static = Op2("cantilever.op2"), Op2("cantilever-tip.op2")
    content = modes.write(tmp_path / "modes.op2", modes.changed()).read_bytes()
    for length in (0, 100, len(content) // 3, len(content) // 2, len(content) - 20):
        (tmp_path / "cut.op2").write_bytes(content[:length])
        with pytest.raises(ValueError, match="cut.op2 cannot be read; it must be a whole .op2 file: is it cut off?"):
            structures.from_nastran(tmp_path / "cut.op2", TIP, modal_masses=1.0)
    with pytest.raises(FileNotFoundError, match="none.op2"):
        structures.from_nastran(tmp_path / "none.op2", TIP)
    for factor, force, told in ((0.0, 1.0, "displacement of tip along its direction = 0.0"), (1.0, 0.0, "force = 0.0"), (1.0, -1.0, "sign of the force")):
        still = static.write(tmp_path / "still.op2", static.changed(factor=factor))
        with pytest.raises(ValueError, match=told):
            structures.from_nastran(tmp_path / "modes.op2", TIP, {"tip": still}, modal_masses=1.0, force=force)


def chain(springs, masses):
    """Masses in a row, the first on a spring to the ground, which may be 0."""
    k = np.diag(np.asarray(springs, dtype=float))
    for i, spring in enumerate(springs[1:]):
        k[i, i] += spring
        k[i, i + 1] -= spring
        k[i + 1, i] -= spring
    return k, np.diag(np.asarray(masses, dtype=float))


def test_matrices_that_no_structure_has_are_refused():
    pytest.importorskip("scipy")
    k, m = chain([1e5] * 30, [0.5] * 30)
    exact = structures.from_matrices(k, m, {"p": 29}, 3)
    # Far from the lowest modes, where the eigenvalues that are computed do not show it.
    for place in (0, 12, 29):
        for name, pair in (("stiffness", (k - 9e5 * np.diag(np.arange(30) == place), m)), ("mass", (k, m - 9 * np.diag(np.arange(30) == place)))):
            with pytest.raises(ValueError, match=f"{name} is not allowed; it must be without negative eigenvalues"):
                structures.from_matrices(*pair, {"p": 29}, 3)
    # Structural damping as an imaginary part.
    with pytest.raises(ValueError, match="stiffness is not allowed; it must be a matrix of real numbers"):
        structures.from_matrices(k * (1 + 0.02j), m, {"p": 29}, 3)
    assert np.array_equal(structures.from_matrices(k + 0j, m, {"p": 29}, 3).omega_rad_s, exact.omega_rad_s)
    # Modes below the shift would be left out.
    with pytest.raises(ValueError, match="shift = 5000.0 is not allowed; it must be less than the lowest eigenvalue"):
        structures.from_matrices(k, m, {"p": 29}, 3, shift=5e3)
    assert structures.from_matrices(k, m, {"p": 29}, 3, shift=100.0).omega_rad_s == pytest.approx(exact.omega_rad_s)


def test_numbers_of_a_matrix_file_are_read_whole_or_refused(tmp_path):
    pytest.importorskip("scipy")
    head = "%%MatrixMarket matrix coordinate real symmetric\n% two masses on two springs\n"
    stiffness = head + "2 2 3\n1 1 2.0e+5\n2 1 -1.0e+5\n2 2 1.0e+5\n"

    def read(mass, name="mass.mtx"):
        (tmp_path / "stiffness.mtx").write_text(stiffness.replace("\n", "\r\n"), newline="")
        (tmp_path / name).write_bytes(mass if isinstance(mass, bytes) else mass.encode())
        return structures.from_matrices(tmp_path / "stiffness.mtx", tmp_path / name, {"p": 1}, 1).omega_rad_s[0]

    whole = head + "2 2 2\n1 1 5.0e-1\n2 2 5.0e-1\n"
    exact = math.sqrt(1e5 / 0.5 * (3 - math.sqrt(5)) / 2)
    for mass, name in [(whole, "mass.mtx"), (whole.replace("5.0e-1", ".5"), "mass.mtx"), (gzip.compress(whole.encode()), "mass.mtx.gz")]:
        assert read(mass, name) == pytest.approx(exact, rel=1e-9)
    # Exponents as Fortran writes them, a decimal comma, and a file that is cut off.
    for mass, told in [
        (whole.replace("e-", "D-"), "mass.mtx, line 4: '5.0D-1' is not allowed"),
        (whole.replace("e-", "-"), "mass.mtx, line 4: '5.0-1' is not allowed"),
        (whole.replace("5.0e-1", "0,5"), "mass.mtx, line 4: '0,5' is not allowed"),
        (whole[:-2], "mass.mtx, line 5: '5.0e-' is not allowed"),
        (whole[:-7], "mass.mtx is not a whole Matrix Market file"),
        (whole[:-11], "mass.mtx is not a whole Matrix Market file"),
        # a file that is cut within a number may end with another number
        (whole[:-4], "mass.mtx is not a whole Matrix Market file: line 5, '2 2 5.0', must end with a line break"),
        (head.replace("real", "pattern") + "2 2 2\n1 1\n2 2\n", "mass.mtx, line 1: pattern is not allowed; it must be real"),
        ("1 2 3", "mass.mtx is not a Matrix Market file"),
    ]:
        with pytest.raises(ValueError, match=told):
            read(mass)
    with pytest.raises(ValueError, match="mass.mtx.gz is not a whole compressed file"):
        read(gzip.compress(whole.encode())[:-9], "mass.mtx.gz")
    with pytest.raises(ValueError, match="mass is not allowed; it must have an entry other than 0"):
        structures.from_matrices(np.eye(3), np.zeros((3, 3)), {"p": 0}, 1)
    with pytest.raises(ValueError, match="every degree of freedom has stiffness or mass"):
        structures.from_matrices(np.diag([1.0, 2.0, 0.0]), np.diag([1.0, 1.0, 0.0]), {"p": 0}, 1)


def test_damping_ratios_are_one_for_all_modes_or_one_for_each():
    folder = FILES / "calculix"
    files = (folder / "cantilever.dat", folder / "cantilever.frd", {"tip": (293, UP)})
    assert list(structures.from_calculix(*files, damping_ratios=0.01).damping_ratios) == [0.01] * 8
    each = [0.001 * k for k in range(8)]
    assert list(structures.from_calculix(*files, damping_ratios=each).damping_ratios) == each
    with pytest.raises(ValueError, match="damping_ratios = 2 values is not allowed; it must be as long as the number of modes, 8"):
        structures.from_calculix(*files, damping_ratios=[0.01, 0.02])


def test_a_soft_support_beside_a_stiff_part_is_not_lost():
    pytest.importorskip("scipy")
    # A ground spring of 1 N/m below a stiff link is lost in the sum of both, or a share of it is.
    with pytest.raises(ValueError, match="their rounding changes it by up to"):
        structures.from_matrices(*chain([1.0, 1e14, 1.0], [1, 1, 1]), {"p": 1}, 1)
    for link in (1e16, 1e20):
        with pytest.raises(ValueError, match="rigid_modes = 0 is not allowed; it must be 1, .* a soft spring is lost"):
            structures.from_matrices(*chain([1.0, link], [1, 1]), {"p": 1}, 1)
    for link, accuracy in ((1e6, 1e-5), (1e12, 5e-3)):
        found = structures.from_matrices(*chain([1.0, link], [1, 1]), {"p": 1}, 1)
        assert found.omega_rad_s[0] == pytest.approx(math.sqrt(0.5), rel=accuracy)
        assert found.static_compliances_m_n["p"] == pytest.approx(1.0, rel=accuracy)


def test_files_of_calculix_that_are_not_whole_or_belong_to_other_jobs_are_refused(tmp_path):
    folder = FILES / "calculix"
    dat, frd, static = ((folder / name).read_text() for name in ("cantilever.dat", "cantilever.frd", "cantilever-tip.frd"))
    points = {"tip": (293, UP)}

    def read(static_force=1.0, **changed):
        texts = {"modes.dat": dat, "modes.frd": frd, "static.frd": static} | {k.replace("_", "."): v for k, v in changed.items()}
        for name, text in texts.items():
            (tmp_path / name).write_text(text)
        return structures.from_calculix(
            tmp_path / "modes.dat", tmp_path / "modes.frd", points, {"tip": tmp_path / "static.frd"}, force=static_force
        )

    assert np.array_equal(read().shapes["tip"], calculix().shapes["tip"])
    assert np.array_equal(read(modes_frd=frd + "\n\n").shapes["tip"], calculix().shapes["tip"])
    # Cut off at any place: within a number, at the end of a line, before the last line.
    last = frd.rindex(" -1       293")
    for place in (0, 1000, last, last + 20, last + 47, len(frd) - 6):
        with pytest.raises(ValueError, match="modes.frd is not a whole .frd file"):
            read(modes_frd=frd[:place])
    with pytest.raises(ValueError, match="static.frd is not a whole .frd file"):
        read(static_frd=static[: static.rindex(" -3")])
    with pytest.raises(ValueError, match="modes.frd contains 8 shapes, and .*modes.dat 5 frequencies"):
        read(modes_dat=dat[: dat.index("      6   0.2649663E+09")])
    # A line that is lost or damaged within the file.
    row = next(line for line in frd[last:].splitlines() if line.startswith(" -1       293"))
    with pytest.raises(ValueError, match="modes.frd, line .*: 1 displacements are not allowed; there must be 2"):
        read(modes_frd=frd.replace(row + "\n", ""))
    with pytest.raises(ValueError, match="modes.frd, line .*: could not convert"):
        read(modes_frd=frd.replace(row, row[:30]))
    with pytest.raises(ValueError, match="modes.frd, line .*: format 2 of its results"):
        read(modes_frd=frd.replace("1MODAL      1", "1MODAL      2"))
    with pytest.raises(ValueError, match=r"modes.frd: the eigenvalue of mode 2 = 1747766.0 is not allowed; it must be 1847766.0"):
        read(modes_dat=dat.replace("0.1747766E+07", "0.1847766E+07"))
    # A load of 0, or of the other sign.
    still = "\n".join(line[:13] + 3 * " 0.00000E+00" if line.startswith(" -1       293") else line for line in static.split("\n"))
    with pytest.raises(ValueError, match="static.frd: the displacement of tip along its direction = 0.0 .* is the point loaded"):
        read(static_frd=still)
    for force, told in ((0.0, "force = 0.0 is not allowed"), (-1.0, "must have the sign of the force, -1.0")):
        with pytest.raises(ValueError, match=told):
            read(static_force=force)
    with pytest.raises(ValueError, match="node 7 is not in .* write it with OUTPUT=2D"):
        structures.from_calculix(folder / "cantilever.dat", folder / "cantilever.frd", {"tip": (7, UP)})


def test_shapes_of_a_table_are_scaled_to_unit_modal_masses(tmp_path):
    (tmp_path / "normalised.csv").write_text(
        "frequency_hz,damping_ratio,tip,tip_sd,middle\n33.4,0.004,2.0,0.03,0.75\n209.4,0.005,-2.0,0.04,1.5\n"
    )
    # The same shapes, 1 at the tip.
    (tmp_path / "masses.csv").write_text(
        "frequency_hz,damping_ratio,modal_mass_kg,tip,tip_sd,middle\n33.4,0.004,0.25,1,0.015,0.375\n209.4,0.005,0.25,-1,0.02,0.75\n"
    )
    exact, found = (structures.from_table(tmp_path / name, {"tip": 1e-3}) for name in ("normalised.csv", "masses.csv"))
    for name, shape in exact.shapes.items():
        assert found.shapes[name] == pytest.approx(shape)
    assert found.standard_deviations["points.tip.shape"] == pytest.approx(exact.standard_deviations["points.tip.shape"])
    assert "points.middle.shape" not in found.standard_deviations
    # An impact on either is the same.
    scene = own_beam(0.5) | {"location": "tip"}
    del scene["location_m"]
    one, two = (vibroimpact.simulate(scene | {"structure": structure.modal()}) for structure in (exact, found))
    assert one["restitution"] == pytest.approx(two["restitution"], rel=1e-9)
    # A modal mass of 0.25 +- 0.02 kg: 4 % of the shapes.
    text = (tmp_path / "masses.csv").read_text().replace("tip_sd,middle", "tip_sd,middle,modal_mass_kg_sd")
    (tmp_path / "uncertain.csv").write_text("\n".join(row + ("" if row.startswith("f") else ",0.02") for row in text.splitlines()))
    found = structures.from_table(tmp_path / "uncertain.csv")
    assert found.standard_deviations["points.tip.shape"] == pytest.approx(np.hypot([0.03, 0.04], 0.08))
    assert found.standard_deviations["points.middle.shape"] == pytest.approx([0.03, 0.06])


def test_static_loads_at_other_points_are_refused(tmp_path):
    readers = [(structures.from_calculix, ("cantilever.dat", "cantilever.frd"), "calculix", (293, 149), "frd", {})]
    readers += [(structures.from_nastran, ("cantilever.op2",), "nastran", (21, 11), "op2", {"modal_masses": 1.0})]
    for reader, modes, folder, nodes, kind, more in readers:
        if folder == "nastran":
            pytest.importorskip("pyNastran")
        inside = FILES / folder
        points = {name: (node, UP) for name, node in zip(("tip", "middle"), nodes, strict=True)}
        tip, middle = (inside / f"cantilever-{name}.{kind}" for name in points)

        def read(static, wanted=points, force=1.0):
            return reader(*(inside / name for name in modes), wanted, static, force=force, **more)

        # The tip is moved less by a load in the middle than by one at the tip, and less than its modes alone would let it move.
        with pytest.raises(ValueError, match="displacement of tip along its direction = .* must be at least .* that of the listed modes"):
            read({"tip": middle}, {"tip": points["tip"]})
        # A load of 2 N that is taken for 1 N is not noticed, nor can it be; one of 0.5 N is.
        with pytest.raises(ValueError, match="must be at least .* by 2.0"):
            read({"tip": tip}, force=2.0)
        # A load at the tip moves the middle more than one in the middle.
        with pytest.raises(ValueError, match=f"cantilever-tip.{kind}: the displacement of .* is not allowed; it must be"):
            read({"tip": tip, "middle": tip})
        exact = read({"tip": tip, "middle": middle}).static_compliances_m_n
        assert read({"middle": middle}).static_compliances_m_n["middle"] == exact["middle"]
