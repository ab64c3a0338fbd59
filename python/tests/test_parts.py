"""Scenes as dataclasses: the same fields as in the file, checked by the program."""

import dataclasses
import json
import os

import make_parts
import numpy as np
import pytest
import vibroimpact
from conftest import SCENES
from test_same_as_command_line import plain
from vibroimpact import Beam, Hertz, InvalidInput, Modal, MovingMode, Point, Scene, Segment, Start, Striker, parts

SCENE = Scene(
    structure=Beam(
        ends=("pinned", "pinned"),
        damping_ratio=0.02,
        segments=[Segment(length_m=1, width_m=0.011323, thickness_m=0.011323, youngs_modulus_pa=2e11, density_kg_m3=7800)],
    ),
    striker=Striker(density_kg_m3=7800, radius_m=0.015, speed_m_s=1),
    contact=Hertz(youngs_modulus_pa=2e11, poissons_ratio=0.3),
    location_m=0.6180339887498949,
    modes=40,
)


def test_the_module_is_that_of_the_schema():
    made = make_parts.Maker().module()
    if os.environ.get("VIBROIMPACT_BLESS") == "1":
        make_parts.PARTS.write_text(made, encoding="utf-8")
    assert make_parts.PARTS.read_text(encoding="utf-8") == made, "run python/tools/make_parts.py"
    assert set(parts.__all__) <= set(vibroimpact.__all__)


def test_a_scene_of_parts_is_that_of_the_file(scene):
    del scene["description"]
    assert json.loads(json.dumps(SCENE, default=dict)) == scene
    assert plain(vibroimpact.simulate(SCENE)) == plain(vibroimpact.simulate(scene))


def rebuilt(name, tree):
    """A part from a tree as in a file."""
    if name in make_parts.TAGGED:
        tag = make_parts.TAGGED[name]
        name = "".join(word.capitalize() for word in tree[tag].split("-"))
        tree = {field: value for field, value in tree.items() if field != tag}
    inner = {
        "structure": "Structure", "striker": "Striker", "contact": "Contact", "start": "Start",
        "segments": "Segment", "attachments": "Attachment", "supports": "Support", "moving_modes": "MovingMode",
    }  # fmt: skip

    def field(key, value):
        if key == "points":
            return {point: rebuilt("Point", entry) for point, entry in value.items()}
        if key not in inner:
            return value
        return [rebuilt(inner[key], one) for one in value] if isinstance(value, list) else rebuilt(inner[key], value)

    return getattr(vibroimpact, name)(**{key: field(key, value) for key, value in tree.items()})


@pytest.mark.parametrize("path", sorted(SCENES.glob("*.json")), ids=lambda path: path.name)
def test_every_scene_of_the_gallery_can_be_built(path):
    tree = json.loads(path.read_text())
    for key in ("$schema", "version"):
        tree.pop(key, None)
    assert json.loads(json.dumps(rebuilt("Scene", tree), default=dict)) == tree


def test_arrays_and_nested_parts():
    shape = np.array([1.0, -0.5])
    structure = Modal(omega_rad_s=np.array([300.0, 1900.0]), points={"tip": Point(shape=shape)})
    start = Start(moving_modes=[MovingMode(mode=1, velocity_m_s=0.1)])
    scene = Scene(
        structure=structure,
        striker=Striker(mass_kg=0.1, speed_m_s=1),
        contact=Hertz(stiffness_n_m1_5=1e9),
        location="tip",
        start=start,
    )
    found = vibroimpact.simulate(scene)
    assert found.outcome == "rebound" and found["modes"] == 2


def test_parts_are_mappings_and_values():
    assert list(Striker(mass_kg=1, speed_m_s=2)) == ["speed_m_s", "mass_kg"]
    assert SCENE["structure"]["kind"] == "beam" and "location" not in SCENE and len(SCENE.contact) == 3
    faster = dataclasses.replace(SCENE, striker=dataclasses.replace(SCENE.striker, speed_m_s=2))
    assert faster != SCENE and faster == dataclasses.replace(faster)
    assert repr(SCENE.contact) == "Hertz(poissons_ratio=0.3, youngs_modulus_pa=200000000000.0)"
    with pytest.raises(dataclasses.FrozenInstanceError):
        SCENE.modes = 3


def test_mistakes_name_the_field():
    with pytest.raises(TypeError, match="lenght_m"):
        Segment(lenght_m=1)
    with pytest.raises(TypeError, match="speed_m_s"):
        Striker(mass_kg=1)
    wrong = dataclasses.replace(SCENE, structure=dataclasses.replace(SCENE.structure, segments=[Segment(length_m=-1)]))
    with pytest.raises(InvalidInput) as found:
        vibroimpact.simulate(wrong)
    assert found.value.field.startswith("structure.segments[0]") and found.value.allowed
    with pytest.raises(InvalidInput) as found:
        vibroimpact.simulate(dataclasses.replace(SCENE, location_m=2))
    assert (found.value.field, found.value.value) == ("location_m", "2")
