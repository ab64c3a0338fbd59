"""The parts that only Python has: kinds of input, arrays, exceptions, threads, signals."""

import _thread
import pickle
import threading
import time
from collections import ChainMap
from types import MappingProxyType

import numpy as np
import pytest
import vibroimpact
from conftest import ASSEMBLIES, SCENES


def test_kinds_of_scenes(scene):
    path = SCENES / "pinned-beam.json"
    expected = vibroimpact.modes(path, 5)["omega_rad_s"]
    numpy_in_it = scene | {"location_m": np.float32(scene["location_m"]), "modes": np.int64(40)}
    views = ChainMap(MappingProxyType(scene | {"striker": MappingProxyType(scene["striker"])}))
    for same in (str(path), scene, numpy_in_it, views):
        np.testing.assert_array_equal(vibroimpact.modes(same, 5)["omega_rad_s"], expected)
    for wrong in (3, None, [scene], b"scene.json"):
        with pytest.raises(TypeError, match="a mapping or the path of a file"):
            vibroimpact.modes(wrong, 5)
    with pytest.raises(TypeError, match="cannot contain a set"):
        vibroimpact.modes(scene | {"location_m": {1}}, 5)


def test_the_exception_names_the_field():
    with pytest.raises(vibroimpact.InvalidInput) as found:
        vibroimpact.infinite_beam(-1)
    fault = found.value
    assert isinstance(fault, ValueError)
    assert (fault.field, fault.value) == ("s", "-1")
    assert str(fault) == f"s = -1 is not allowed; it must be {fault.allowed}"
    # As multiprocessing sends it.
    again = pickle.loads(pickle.dumps(fault))
    assert (str(again), again.field, again.value, again.allowed) == (str(fault), "s", "-1", fault.allowed)
    with pytest.raises(vibroimpact.InvalidInput) as missing:
        vibroimpact.simulate({})
    assert missing.value.value is None


@pytest.mark.parametrize(
    "call",
    [
        lambda: vibroimpact.infinite_beam(float("nan")),
        lambda: vibroimpact.law(2, 0.1, 1),
        lambda: vibroimpact.law(0.5, -0.1, 1),
        lambda: vibroimpact.law(0.5, 0.1, 1, step_s=0),
        lambda: vibroimpact.law(0.5, 0.1, 1, law="hertz"),
        lambda: vibroimpact.turning_points(0),
        lambda: vibroimpact.turning_points(61),
        lambda: vibroimpact.emoc_restitution(-1, [1, 2]),
        lambda: vibroimpact.emoc_restitution(1, [1, float("nan")]),
        lambda: vibroimpact.emoc_restitution(1, [1, 2], mu0=-1),
        lambda: vibroimpact.emoc_restitution(1, 2),
        lambda: vibroimpact.emoc(SCENES / "pinned-beam.json", alpha0=float("inf")),
        lambda: vibroimpact.emoc(SCENES / "infinite-beam.json"),
        lambda: vibroimpact.sweep({"vary": []}),
        lambda: vibroimpact.sweep(SCENES / "pinned-beam.json"),
        lambda: vibroimpact.sweep({}, threads=0),
        lambda: vibroimpact.simulate({"location_m": float("nan")}),
        lambda: vibroimpact.simulate({"bodies": {}, "contacts": [], "end_s": 1}),
        lambda: vibroimpact.simulate({"bodies": {"a": {"kind": "mass", "mass_kg": 0}}, "contacts": [], "end_s": 1}),
        lambda: vibroimpact.orbit(SCENES / "pinned-beam.json"),
        lambda: vibroimpact.orbit(ASSEMBLIES / "sdnl105.json"),
        lambda: vibroimpact.orbit(ASSEMBLIES / "shaken-table.json", over="end_s"),
        lambda: vibroimpact.orbit(ASSEMBLIES / "shaken-table.json", over="contacts[0].name", to=1),
    ],
)
def test_invalid_input(call):
    with pytest.raises(vibroimpact.InvalidInput, match="is (not allowed|missing|not a known field); it must be .|^line 1, column"):
        call()


def test_a_large_sweep_belongs_in_a_folder(scene):
    axis = {"field": "striker.speed_m_s", "from": 0.1, "to": 10, "count": 10_000_001}
    with pytest.raises(vibroimpact.InvalidInput, match="at most 10000000 for a sweep in memory"):
        vibroimpact.sweep({"scene": scene, "vary": [axis]})


def test_errors_in_arrays_name_the_element(scene):
    mass, place, restitution = [0.01, 0.1, 0.5], [0.3, 0.6, 0.9], [0.5, 0.4, 0.3]
    with pytest.raises(vibroimpact.InvalidInput) as found:
        vibroimpact.fit(scene, mass, [0.3, 0.6, 7], restitution)
    assert found.value.field == "location_m[2]"
    with pytest.raises(vibroimpact.InvalidInput, match=r"^restitution\[1\] = NaN is not allowed"):
        vibroimpact.fit(scene, mass, place, [0.5, np.nan, 0.3])
    with pytest.raises(vibroimpact.InvalidInput, match="^restitution = 2 numbers is not allowed; it must be as long"):
        vibroimpact.fit(scene, mass, place, restitution[:2])
    with pytest.raises(vibroimpact.InvalidInput, match="^lines of data = 2 is not allowed"):
        vibroimpact.fit(scene, mass[:2], place[:2], restitution[:2])


def test_arrays_of_a_simulation(scene):
    found = vibroimpact.simulate(scene, history=True)
    assert len(found["sub_impacts"]) == found["sub_impact_count"] > 1
    assert (found["sub_impacts"]["start_s"] < found["sub_impacts"]["end_s"]).all()
    history = found["history"]
    shapes = {column.shape for column in history.values()}
    assert len(shapes) == 1 and all(column.dtype == np.float64 for column in history.values())
    # The impulse of the force is the striker's change of momentum.
    impulse = (np.diff(history["time_s"]) * (history["force_n"][1:] + history["force_n"][:-1]) / 2).sum()
    mass = 2 * found["energy"]["initial_j"] / scene["striker"]["speed_m_s"] ** 2
    change = mass * (found["striker_velocity_m_s"] + scene["striker"]["speed_m_s"])
    assert abs(impulse / change - 1) < 1e-3
    assert abs(found["sub_impacts"]["impulse_n_s"].sum() / change - 1) < 1e-8
    # The energy of the modes at the last separation.
    energies = found["modal_energies"]
    assert energies["energy_j"].shape == (len(energies["time_s"]), found["modes"] + found["remainder_modes"])
    at_end = [np.interp(found["end_s"], energies["time_s"], mode) for mode in energies["energy_j"].T]
    assert abs(sum(at_end) / found["energy"]["structure_j"] - 1) < 0.02


def test_no_contact_has_an_empty_table(scene):
    # A free body that moves away faster than the ball approaches.
    scene["structure"] = {"kind": "modal", "omega_rad_s": [0], "shape_at_location": [1]}
    del scene["location_m"], scene["modes"]
    away = {"moving_modes": [{"mode": 1, "velocity_m_s": -2}]}
    found = vibroimpact.simulate(scene | {"start": away})
    assert found["outcome"] == "no contact"
    assert found["sub_impacts"].shape == (0,) and found["sub_impacts"]["end_s"].shape == (0,)


def test_emoc_of_arrays(scene):
    masses = np.array([0.01, 0.1, 1.0, 10.0])
    places = np.array([0.1, 0.25, 0.4])
    shapes = np.array([vibroimpact.modes(scene | {"location_m": x}, 40)["shape_at_location"] for x in places])
    table = vibroimpact.emoc_restitution(masses[:, np.newaxis], shapes, mu0=0.5, alpha0=8, alpha1=0.3)
    assert table.shape == (4, 3) and table.dtype == np.float64
    for i, mass in enumerate(masses):
        for k, place in enumerate(places):
            one = scene | {"location_m": place, "striker": {"mass_kg": mass, "radius_m": 0.015, "speed_m_s": 1}}
            assert vibroimpact.emoc(one, mu0=0.5, alpha0=8, alpha1=0.3)["restitution"] == table[i, k]
    # Numbers give a number; any order in memory and any kind of number is accepted.
    assert np.ndim(vibroimpact.emoc_restitution(1, shapes[0])) == 0
    turned = vibroimpact.emoc_restitution(masses[:, np.newaxis], np.asfortranarray(shapes), mu0=0.5, alpha0=8, alpha1=0.3)
    np.testing.assert_array_equal(table, turned)
    np.testing.assert_array_equal(vibroimpact.emoc_restitution(1, [[1, 2]]), vibroimpact.emoc_restitution([1.0], [1.0, 2.0]))
    assert vibroimpact.emoc_restitution([], [1.0]).shape == (0,)
    with pytest.raises(ValueError, match="broadcast"):
        vibroimpact.emoc_restitution([1, 2], np.ones((3, 5)))


def test_a_fit_finds_the_true_parameters(scene):
    chosen = {"mu0": 0.4, "alpha0": 6.0, "alpha1": 0.8}
    mass, place = map(np.ravel, np.meshgrid(np.geomspace(0.01, 10, 12), [0.1, 0.25, 0.4, 0.5]))
    shapes = [vibroimpact.modes(scene | {"location_m": x}, 50)["shape_at_location"] for x in place]
    found = vibroimpact.fit(scene, mass, place, vibroimpact.emoc_restitution(mass, shapes, **chosen))
    assert found["converged"] and found["rms"] < 1e-8
    for name, value in chosen.items():
        assert abs(found[name] / value - 1) < 1e-6
    assert found["intervals"].shape == (3, 2)


def speeds(scene, count):
    return {"scene": scene, "vary": [{"field": "striker.speed_m_s", "from": 0.1, "to": 10, "count": count}]}


def test_a_sweep_does_not_depend_on_threads(scene):
    one, four = (vibroimpact.sweep(speeds(scene, 40), threads=threads) for threads in (1, 4))
    assert list(one) == list(four) and len(one["index"]) == 40
    for name in one:
        np.testing.assert_array_equal(one[name], four[name])
    single = vibroimpact.simulate(scene | {"striker": scene["striker"] | {"speed_m_s": one["striker.speed_m_s"][7]}})
    assert single["restitution"] == one["restitution"][7]


HEAVY = {
    "simulate": lambda scene: vibroimpact.simulate(scene | {"modes": 1000}),
    "modes": lambda scene: vibroimpact.modes(SCENES / "stepped-shaft.toml", 9000),
    "turning_points": lambda scene: vibroimpact.turning_points(30),
    "emoc": lambda scene: vibroimpact.emoc(SCENES / "stepped-shaft.toml", modes=9000),
    "emoc_restitution": lambda scene: vibroimpact.emoc_restitution(np.geomspace(0.01, 10, 1_500_000), np.ones(50)),
    "fit": lambda scene: vibroimpact.fit(
        scene, np.geomspace(0.01, 10, 3000), np.full(3000, 0.4), np.linspace(0.9, 0.1, 3000)
    ),
    "sweep": lambda scene: vibroimpact.sweep(speeds(scene, 200), threads=1),
}


@pytest.mark.parametrize("name", HEAVY)
def test_other_threads_run_meanwhile(name, scene):
    """A thread that wakes every half millisecond does so during the call."""
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.0005)

    other = threading.Thread(target=tick)
    other.start()
    began = time.perf_counter()
    HEAVY[name](scene)
    ended = time.perf_counter()
    done.set()
    other.join()
    within = [t for t in ticks if began + 0.002 < t < ended - 0.002]
    assert ended - began > 0.02, "too short to tell"
    # The ticks are distributed over the whole call, not at its ends, where arguments and results are converted.
    assert len(within) >= 5
    assert max(np.diff([began, *within, ended])) < 0.5 * (ended - began)


BOUNCING = {
    "bodies": {"ball": {"kind": "mass", "mass_kg": 0.1, "position_m": 1e-4}},
    "contacts": [
        {"name": "floor", "between": [{"body": "ball"}, "ground"], "law": "linear-spring", "stiffness_n_m": 1e7}
    ],
    "gravity_m_s2": 9.81,
    "loads": [{"body": "ball", "force_n": 0.1, "frequency_hz": 3}],
    "end_s": 1e5,
}
LONG = {
    "simulate": lambda: vibroimpact.simulate(BOUNCING),
    "orbit": lambda: vibroimpact.orbit(BOUNCING, transient=1_000_000),
    "branch": lambda: vibroimpact.orbit(BOUNCING, transient=1_000_000, over="loads[0].force_n", to=0.2),
}


@pytest.mark.parametrize("name", LONG)
def test_control_c_keeps_the_result_so_far(name):
    timer = threading.Timer(0.3, _thread.interrupt_main)
    timer.start()
    began = time.perf_counter()
    with pytest.raises(KeyboardInterrupt) as stopped:
        LONG[name]()
    assert time.perf_counter() - began < 20
    assert isinstance(stopped.value, vibroimpact.Interrupted)
    result = stopped.value.result
    assert result["scene"]["end_s"] == 1e5
    if name == "simulate":
        assert result["reason"] == "interrupted" and 0 < result["end_s"] < 1e5
        assert len(result.contacts["floor"]["intervals"]) > 1
    elif name == "orbit":
        assert result["outcome"] == "interrupted"
    else:
        assert result["interrupted"] and result["orbits"] == []
    assert pickle.loads(pickle.dumps(stopped.value)).result.keys() == result.keys()


def test_control_c_ends_a_sweep(scene):
    timer = threading.Timer(0.3, _thread.interrupt_main)
    timer.start()
    began = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        vibroimpact.sweep(speeds(scene | {"modes": 200}, 1_000_000))
    assert time.perf_counter() - began < 20
