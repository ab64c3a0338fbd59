"""Writes the inputs of CalculiX and MYSTRAN, the matrices and the measured responses of this folder.

The structure is the same in all: a steel cantilever, 0.5 m long, 0.02 m wide, 0.01 m thick, clamped at the left, struck
across its thickness at the tip and in the middle. `README.md` says which programs were then run. Needs numpy, scipy and
pyuff.
"""

from pathlib import Path

import numpy as np
import pyuff
from scipy.io import mmwrite
from scipy.linalg import eigh
from scipy.sparse import csr_array

HERE = Path(__file__).parent
LENGTH, WIDTH, THICKNESS = 0.5, 0.02, 0.01
MODULUS, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
INERTIA = WIDTH * THICKNESS**3 / 12


def calculix(elements: int = 24) -> None:
    """Quadratic bricks, one across the section, which cannot move sideways in its plane of symmetry."""
    nodes: dict[tuple[int, int, int], int] = {}

    def node(i: int, j: int, k: int) -> int:
        return nodes.setdefault((i, j, k), len(nodes) + 1)

    corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
    edges = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)]
    edges += [(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
    bricks = [[node(2 * e + i, j, k) for i, j, k in corners + edges] for e in range(elements)]
    tip, middle = node(2 * elements, 1, 2), node(elements, 1, 2)

    def numbers(values: list[int]) -> str:
        return ",\n".join(", ".join(map(str, values[k : k + 8])) for k in range(0, len(values), 8)) + "\n"

    text = "** cantilever 0.5 x 0.02 x 0.01 m, steel, 24 elements C3D20; SI units\n*NODE, NSET=ALL\n"
    for (i, j, k), number in nodes.items():
        place = (i * LENGTH / (2 * elements), j * WIDTH / 2, k * THICKNESS / 2)
        text += f"{number}, " + ", ".join(f"{x:.9g}" for x in place) + "\n"
    text += "*ELEMENT, TYPE=C3D20, ELSET=BEAM\n"
    text += "".join(f"{e + 1}, " + numbers(brick) for e, brick in enumerate(bricks))
    text += "*NSET, NSET=FIXED\n" + numbers([number for (i, _, _), number in nodes.items() if i == 0])
    text += "*NSET, NSET=PLANE\n" + numbers([number for (_, j, _), number in nodes.items() if j == 1])
    text += f"*NSET, NSET=SEEN\n{tip}, {middle}\n"
    text += f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{MODULUS:.2E}, {POISSON}\n*DENSITY\n{DENSITY}\n"
    text += "*SOLID SECTION, ELSET=BEAM, MATERIAL=STEEL\n*BOUNDARY\nFIXED, 1, 3\n*BOUNDARY\nPLANE, 2, 2\n*STEP\n"
    written = "*NODE FILE, NSET=SEEN\nU\n*END STEP\n"
    (HERE / "calculix" / "cantilever.inp").write_text(text + "*FREQUENCY\n8\n" + written)
    for name, number in (("tip", tip), ("middle", middle)):
        load = f"*STATIC\n*CLOAD\n{number}, 3, 1.\n"
        (HERE / "calculix" / f"cantilever-{name}.inp").write_text(text + load + written)


def nastran(elements: int = 20) -> None:
    """Bars that bend in one plane."""
    grids = "".join(f"GRID,{i + 1},,{i * LENGTH / elements:.4f},0.0,0.0\n" for i in range(elements + 1))
    bars = "".join(f"CBAR,{i + 1},1,{i + 1},{i + 2},0.0,0.0,1.0\n" for i in range(elements))
    sideways = THICKNESS * WIDTH**3 / 12
    properties = f"PBAR,1,1,{WIDTH * THICKNESS:.4e},{INERTIA:.6e},{sideways:.6e},4.58e-9\n"
    properties += f"MAT1,1,{MODULUS:.2E},,{POISSON},{DENSITY}\nSPC1,1,123456,1\nSPC1,1,1246,2,THRU,{elements + 1}\n"

    def deck(solution: int, case: str, load: str) -> str:
        head = f"SOL {solution}\nCEND\nTITLE = CANTILEVER 0.5 X 0.02 X 0.01 M, STEEL, 20 CBAR\nSPC = 1\n{case}"
        bulk = "DISPLACEMENT(PLOT) = ALL\nBEGIN BULK\nPARAM,POST,-1\n"
        return head + bulk + grids + bars + properties + load + "ENDDATA\n"

    (HERE / "nastran" / "cantilever.bdf").write_text(deck(103, "METHOD = 1\n", "EIGRL,1,,,8\n"))
    for name, grid in (("tip", elements + 1), ("middle", elements // 2 + 1)):
        load = f"FORCE,1,{grid},0,1.0,0.0,0.0,1.0\n"
        (HERE / "nastran" / f"cantilever-{name}.bdf").write_text(deck(101, "LOAD = 1\n", load))


def beam_matrices(elements: int = 40) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and mass of Hermite's cubic elements, clamped at the left: deflection and slope of each further node."""
    h = LENGTH / elements
    stiffness = MODULUS * INERTIA / h**3 * np.array(
        [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h],
         [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
    )
    mass = DENSITY * WIDTH * THICKNESS * h / 420 * np.array(
        [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h],
         [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]
    )
    whole = np.zeros((2, 2 * elements + 2, 2 * elements + 2))
    for e in range(elements):
        part = slice(2 * e, 2 * e + 4)
        whole[0, part, part] += stiffness
        whole[1, part, part] += mass
    return whole[0, 2:, 2:], whole[1, 2:, 2:]


def matrices() -> None:
    for name, matrix in zip(("stiffness", "mass"), beam_matrices(), strict=True):
        mmwrite(HERE / "matrices" / f"{name}.mtx", csr_array(matrix), symmetry="symmetric", precision=17)


def universal(damping: float = 0.004, noise: float = 2e-3) -> None:
    """Accelerances at the tip and in the middle to a force at the tip, with noise, 1 Hz to 800 Hz, as a file of a test."""
    stiffness, mass = beam_matrices()
    eigenvalues, vectors = eigh(stiffness, mass)
    omega = np.sqrt(eigenvalues)
    frequency = np.arange(1.0, 801.0)
    w = 2.0 * np.pi * frequency
    random = np.random.default_rng(58)
    file = HERE / "universal" / "cantilever.uff"
    file.unlink(missing_ok=True)
    sets = []
    for node, place in ((2, -2), (1, len(stiffness) // 2 - 2)):
        shapes = vectors[-2] * vectors[place]
        receptance = (shapes / (omega**2 - w[:, None] ** 2 + 2j * damping * omega * w[:, None])).sum(axis=1)
        response = -(w**2) * receptance
        scatter = random.standard_normal(w.size) + 1j * random.standard_normal(w.size)
        sets.append(pyuff.prepare_58(
            binary=0, func_type=4, rsp_node=node, rsp_dir=3, ref_node=2, ref_dir=3, data=response * (1 + noise * scatter),
            x=frequency, id1="cantilever, synthetic hammer test", id2="None", id3="None", id4="None", id5="None",
            rsp_ent_name="point", ref_ent_name="point", abscissa_spacing=1, abscissa_min=1.0, abscissa_inc=1.0,
            abscissa_spec_data_type=18, ordinate_spec_data_type=12, orddenom_spec_data_type=13, ord_data_type=6,
            num_pts=w.size, z_axis_value=0.0, load_case_id=0, ver_num=0,
        ))
    pyuff.UFF(str(file)).write_sets(sets, "add")


for folder in ("calculix", "nastran", "matrices", "universal"):
    (HERE / folder).mkdir(exist_ok=True)
calculix()
nastran()
matrices()
universal()
