"""The parts of a scene of one impact: dataclasses with the fields of the scene file, in SI units.

Written by ``tools/make_parts.py`` from the JSON Schema of scenes. An omitted field is ``None`` here and is not written to the
scene; the values of fields are checked when the scene is used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, Union

import numpy as np
from numpy.typing import NDArray

from ._part import Part

__all__ = [
    "Attachment",
    "Beam",
    "Contact",
    "DroppedRod",
    "Elastoplastic",
    "Felt",
    "Flores",
    "Hertz",
    "HuntCrossley",
    "Hysteretic",
    "InfiniteBeam",
    "InfinitePlate",
    "KelvinVoigt",
    "LankaraniNikravesh",
    "LinearSpring",
    "Modal",
    "ModesFile",
    "MovingMode",
    "Plate",
    "Point",
    "Power",
    "Scene",
    "Segment",
    "Start",
    "Striker",
    "String",
    "Structure",
    "Support",
    "Viscous",
]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Attachment(Part):
    """Masses and springs fixed to a beam at one location; all fields but the location may be left out.

    ``location_m``: Location on the beam from its left end (m).
    ``mass_kg``: Mass (kg); 0 when left out.
    ``rotary_inertia_kg_m2``: Rotary inertia about the axis of bending (kg m^2); 0 when left out.
    ``rotational_spring_n_m_rad``: Rotational spring between beam and ground (N m/rad); 0 when left out.
    ``spring_n_m``: Spring between beam and ground (N/m); 0 when left out.
    """

    location_m: float
    mass_kg: float | None = None
    rotary_inertia_kg_m2: float | None = None
    rotational_spring_n_m_rad: float | None = None
    spring_n_m: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Support(Part):
    """A rigid support between the ends of a beam: no displacement, no moment.

    ``location_m``: Location on the beam from its left end (m).
    """

    location_m: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Segment(Part):
    """A uniform piece of a beam: its length, and its section in one of three ways: flexural rigidity and mass per length;
    material, width and thickness; or material and diameter. Timoshenko's theory also needs shear rigidity and rotary
    inertia in the first way, Poisson's ratio in the others.

    ``length_m``: Length (m).
    ``density_kg_m3``: Density (kg/m^3).
    ``diameter_m``: Diameter of a circular section (m).
    ``flexural_rigidity_n_m2``: Flexural rigidity ``EI`` (N m^2).
    ``mass_per_length_kg_m``: Mass per length (kg/m).
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio, for Timoshenko's theory: it gives the shear modulus and the shear coefficient.
    ``rotary_inertia_kg_m``: Rotary inertia per length ``rho I`` (kg m), beside the flexural rigidity.
    ``shear_coefficient``: Shear coefficient ``kappa`` of Timoshenko's theory. When left out: ``5(1+nu)/(6+5nu)`` for a
        rectangle, ``6(1+nu)^2/(7+12nu+4nu^2)`` for a circle, which follow elasticity better than Cowper's.
    ``shear_rigidity_n``: Shear rigidity ``kappa G A`` (N), beside the flexural rigidity.
    ``thickness_m``: Thickness of a rectangular section, in the direction of the impact (m).
    ``width_m``: Width of a rectangular section, across the direction of the impact (m).
    ``youngs_modulus_pa``: Young's modulus (Pa).
    """

    length_m: float
    density_kg_m3: float | None = None
    diameter_m: float | None = None
    flexural_rigidity_n_m2: float | None = None
    mass_per_length_kg_m: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    rotary_inertia_kg_m: float | None = None
    shear_coefficient: float | None = None
    shear_rigidity_n: float | None = None
    thickness_m: float | None = None
    width_m: float | None = None
    youngs_modulus_pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Point(Part):
    """A point of a structure that is given by its modes.

    ``shape``: Shapes at the point: mass-normalised (kg^-1/2), or normalised to ``modal_mass_kg``.
    ``residual_compliance_m_n``: Static compliance (m/N) of the modes beyond the list alone, in place of
        ``static_compliance_m_n``. It stays the same if the listed modes vary.
    ``static_compliance_m_n``: Static compliance at the point (m/N) of the whole elastic structure, modes beyond the list
        included; needed for ``"residual_compliance": true`` only.
    """

    shape: Sequence[float] | NDArray[np.float64]
    residual_compliance_m_n: float | None = None
    static_compliance_m_n: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class MovingMode(Part):
    """The motion of one mode, given at a location where the mode moves.

    ``mode``: Number of the mode, from 1 for the lowest (a rigid-body mode, where there is one).
    ``displacement_m``: Displacement there (m); 0 when left out.
    ``location``: Name of the point of a modal structure; the point of impact when left out.
    ``location_m``: Location on a beam, string or plate (m), as the scene's ``location_m``; the point of impact when left
        out.
    ``velocity_m_s``: Velocity there (m/s); 0 when left out.
    """

    mode: int
    displacement_m: float | None = None
    location: str | None = None
    location_m: float | Sequence[float] | NDArray[np.float64] | None = None
    velocity_m_s: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Start(Part):
    """Motion of the structure at the start, and distance of the striker. Displacements and velocities are positive towards
    the striker. Motions that are given in different fields are added.

    ``amplitude_m_kg0_5``: Amplitudes of the first mass-normalised modes (m kg^1/2), where modes are listed in the order of
        the list; those of the rest are 0.
    ``gap_m``: Distance from the striker to the structure's deflected surface (m); 0, touching, when left out.
    ``moving_modes``: Modes whose motion is given at a location.
    ``rate_m_kg0_5_s``: Their rates (m kg^1/2 / s); those of the rest are 0.
    """

    amplitude_m_kg0_5: Sequence[float] | NDArray[np.float64] | None = None
    gap_m: float | None = None
    moving_modes: Sequence[MovingMode] | None = None
    rate_m_kg0_5_s: Sequence[float] | NDArray[np.float64] | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Striker(Part):
    """The compact body: its mass (or a solid sphere's density and radius) and its speed.

    ``speed_m_s``: Speed towards the structure (m/s).
    ``density_kg_m3``: Density of a solid sphere (kg/m^3), in place of its mass.
    ``immovable``: Whether the striker is a stop that never moves, of infinite mass; ``false`` when left out. Its speed is
        then 0, and ``start`` states the motion of the structure towards it.
    ``mass_kg``: Mass (kg), or ``density_kg_m3`` and ``radius_m`` in its place.
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``radius_m``: Radius of curvature at the point of contact (m); needed where the contact's stiffness comes from
        materials.
    """

    speed_m_s: float
    density_kg_m3: float | None = None
    immovable: bool | None = None
    mass_kg: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    radius_m: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Beam(Part):
    """A beam of uniform segments by Euler-Bernoulli's or Timoshenko's theory, whose modes are computed.

    ``ends``: How the left and the right end are held.
    ``segments``: The segments from left to right; at least one.
    ``attachments``: Masses and springs fixed to the beam.
    ``axial_force_n``: Axial force (N), tension positive, which keeps its direction; Euler-Bernoulli only; 0 when left out.
    ``damping_ratio``: Damping ratio of every mode; 0 when left out.
    ``damping_ratios``: Damping ratios of the first elastic modes; those beyond have ``damping_ratio``.
    ``foundation_n_m2``: Stiffness per length of an elastic foundation under the whole beam (N/m^2); Euler-Bernoulli only; 0
        when left out.
    ``rayleigh_mass_per_s``: Rayleigh damping by mass (1/s): adds ``rayleigh_mass_per_s / (2 omega)`` to the damping ratio
        of every elastic mode.
    ``rayleigh_stiffness_s``: Rayleigh damping by stiffness (s): adds ``rayleigh_stiffness_s omega / 2`` to the damping
        ratio of every mode.
    ``supports``: Rigid supports between the ends.
    ``theory``: Theory of bending. When left out: ``"auto"`` where the program chooses the modes, otherwise ``"euler-
        bernoulli"``, as in the thesis.
    """

    tag: ClassVar[tuple[str, str]] = ("kind", "beam")

    ends: Sequence[Literal["clamped", "pinned", "free", "guided"]]
    segments: Sequence[Segment]
    attachments: Sequence[Attachment] | None = None
    axial_force_n: float | None = None
    damping_ratio: float | None = None
    damping_ratios: Sequence[float] | NDArray[np.float64] | None = None
    foundation_n_m2: float | None = None
    rayleigh_mass_per_s: float | None = None
    rayleigh_stiffness_s: float | None = None
    supports: Sequence[Support] | None = None
    theory: Literal["euler-bernoulli", "timoshenko", "auto"] | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class String(Part):
    """A string under tension, with or without stiffness.

    ``length_m``: Length between the ends (m).
    ``tension_n``: Tension (N).
    ``mass_per_length_kg_m``: Mass per length (kg/m).
    ``damping_ratio``: Damping ratio of every mode; 0 when left out.
    ``flexural_rigidity_n_m2``: Flexural rigidity ``EI`` of a string that resists bending (N m^2); 0 when left out.
    """

    tag: ClassVar[tuple[str, str]] = ("kind", "string")

    length_m: float
    tension_n: float
    mass_per_length_kg_m: float
    damping_ratio: float | None = None
    flexural_rigidity_n_m2: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Plate(Part):
    """A rectangular plate, whose modes are computed.

    ``length_m``: Length, along x (m).
    ``width_m``: Width, along y (m).
    ``thickness_m``: Thickness, in the direction of the impact (m).
    ``edges``: How the edges at x = 0, x = length, y = 0 and y = width are held.
    ``damping_ratio``: Damping ratio of every mode; 0 when left out.
    ``density_kg_m3``: Density (kg/m^3).
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio.
    ``shear_coefficient``: Shear coefficient of Mindlin's theory; 5/(6 - Poisson's ratio) when left out.
    ``theory``: The theory of bending; Kirchhoff's when left out.
    ``youngs_modulus_pa``: Young's modulus (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("kind", "plate")

    length_m: float
    width_m: float
    thickness_m: float
    edges: Sequence[Literal["clamped", "pinned", "free"]]
    damping_ratio: float | None = None
    density_kg_m3: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    shear_coefficient: float | None = None
    theory: Literal["kirchhoff", "mindlin"] | None = None
    youngs_modulus_pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Modal(Part):
    """Any linear structure, given by its modes (measured, or from finite elements).

    ``omega_rad_s``: Angular frequencies (rad/s); 0 for a rigid-body mode.
    ``damping_ratios``: Damping ratios, one for each mode; all 0 when left out.
    ``modal_mass_kg``: Modal masses to which the shapes are normalised (kg), one for each mode. When left out, shapes are
        mass-normalised: 1 kg each.
    ``points``: Points of the structure by their names, in place of ``shape_at_location`` and the compliance there.
    ``residual_compliance_m_n``: Static compliance (m/N) of the modes beyond the list alone, in place of
        ``static_compliance_m_n``. It stays the same if the listed modes vary.
    ``shape_at_location``: Shapes at the point of impact: mass-normalised (kg^-1/2), or normalised to ``modal_mass_kg``.
    ``static_compliance_m_n``: Static compliance at the point of impact (m/N) of the whole elastic structure, modes beyond
        the list included; needed for ``"residual_compliance": true`` only.
    """

    tag: ClassVar[tuple[str, str]] = ("kind", "modal")

    omega_rad_s: Sequence[float] | NDArray[np.float64]
    damping_ratios: Sequence[float] | NDArray[np.float64] | None = None
    modal_mass_kg: Sequence[float] | NDArray[np.float64] | None = None
    points: Mapping[str, Point] | None = None
    residual_compliance_m_n: float | None = None
    shape_at_location: Sequence[float] | NDArray[np.float64] | None = None
    static_compliance_m_n: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ModesFile(Part):
    """The same from a table of comma-separated values in the folder of the scene.

    ``file``: Path of the table, relative to the scene file; the table is in the same folder or below it.
    ``static_compliances_m_n``: Static compliances (m/N) of the whole elastic structure at points of the table, by their
        names; needed for ``"residual_compliance": true`` only.
    """

    tag: ClassVar[tuple[str, str]] = ("kind", "modes-file")

    file: str
    static_compliances_m_n: Mapping[str, float] | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class InfiniteBeam(Part):
    """A beam without ends.

    ``density_kg_m3``: Density (kg/m^3).
    ``diameter_m``: Diameter of a circular section (m).
    ``flexural_rigidity_n_m2``: Flexural rigidity ``EI`` (N m^2).
    ``mass_per_length_kg_m``: Mass per length (kg/m).
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio: it gives the shear modulus and the shear coefficient of Timoshenko's theory.
    ``rotary_inertia_kg_m``: Rotary inertia per length ``rho I`` (kg m), beside the flexural rigidity.
    ``shear_coefficient``: Shear coefficient of Timoshenko's theory; that of the section when left out, as for a
        ``Segment``.
    ``shear_rigidity_n``: Shear rigidity ``kappa G A`` (N), beside the flexural rigidity.
    ``thickness_m``: Thickness of a rectangular section, in the direction of the impact (m).
    ``width_m``: Width of a rectangular section, across the direction of the impact (m).
    ``youngs_modulus_pa``: Young's modulus (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("kind", "infinite-beam")

    density_kg_m3: float | None = None
    diameter_m: float | None = None
    flexural_rigidity_n_m2: float | None = None
    mass_per_length_kg_m: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    rotary_inertia_kg_m: float | None = None
    shear_coefficient: float | None = None
    shear_rigidity_n: float | None = None
    thickness_m: float | None = None
    width_m: float | None = None
    youngs_modulus_pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class InfinitePlate(Part):
    """A thin plate without edges.

    ``thickness_m``: Thickness (m).
    ``density_kg_m3``: Density (kg/m^3).
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio.
    ``youngs_modulus_pa``: Young's modulus (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("kind", "infinite-plate")

    thickness_m: float
    density_kg_m3: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    youngs_modulus_pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DroppedRod(Part):
    """A tilted rod that falls on an immovable floor.

    ``length_m``: Length (m).
    ``diameter_m``: Diameter (m); the ends are hemispheres of half of it in radius.
    ``inclination_deg``: Angle between rod and floor (degrees): 0 for a lying rod, 90 for an upright one.
    ``axial_modes``: Number of axial modes; 20 when left out.
    ``bending_modes``: Number of bending modes; 40 when left out.
    ``damping_ratio``: Damping ratio of the elastic modes; 0 when left out.
    ``density_kg_m3``: Density (kg/m^3).
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio.
    ``youngs_modulus_pa``: Young's modulus (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("kind", "dropped-rod")

    length_m: float
    diameter_m: float
    inclination_deg: float
    axial_modes: int | None = None
    bending_modes: int | None = None
    damping_ratio: float | None = None
    density_kg_m3: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    youngs_modulus_pa: float | None = None


Structure = Union[
    Beam,
    String,
    Plate,
    Modal,
    ModesFile,
    InfiniteBeam,
    InfinitePlate,
    DroppedRod,
]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Hertz(Part):
    """Elastic contact of curved bodies.

    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio of both bodies; of the structure alone where the striker's own is given.
    ``stiffness_n_m1_5``: The stiffness itself (N/m^1.5).
    ``striker_material``: Material of the striker, in place of its numbers; a number beside it takes precedence
    ``striker_poissons_ratio``: Poisson's ratio of a striker of another material.
    ``striker_youngs_modulus_pa``: Young's modulus of a striker of another material (Pa).
    ``youngs_modulus_pa``: Young's modulus of both bodies; of the structure alone where the striker's own is given (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("law", "hertz")

    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    stiffness_n_m1_5: float | None = None
    striker_material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    striker_poissons_ratio: float | None = None
    striker_youngs_modulus_pa: float | None = None
    youngs_modulus_pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Viscous(Part):
    """The thesis's viscous dissipation.

    ``damping_s_m``: Damping ``c`` of thesis Eq. 3.15 (s/m), or ``restitution`` in its place.
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio of both bodies; of the structure alone where the striker's own is given.
    ``restitution``: Restitution at a wall.
    ``stiffness_n_m1_5``: The stiffness itself (N/m^1.5).
    ``striker_material``: Material of the striker, in place of its numbers; a number beside it takes precedence
    ``striker_poissons_ratio``: Poisson's ratio of a striker of another material.
    ``striker_youngs_modulus_pa``: Young's modulus of a striker of another material (Pa).
    ``youngs_modulus_pa``: Young's modulus of both bodies; of the structure alone where the striker's own is given (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("law", "viscous")

    damping_s_m: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    restitution: float | None = None
    stiffness_n_m1_5: float | None = None
    striker_material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    striker_poissons_ratio: float | None = None
    striker_youngs_modulus_pa: float | None = None
    youngs_modulus_pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Hysteretic(Part):
    """The thesis's rate-independent dissipation. A stiffness from materials is divided by ``1 + theta_m + beta``, so that
    first loading follows Hertz (thesis 3.3.4); ``stiffness_n_m1_5`` is used unchanged.

    ``theta_m``: Centre of the internal variable.
    ``beta``: Half width of the internal variable's range.
    ``k_bar``: How fast the internal variable follows the compression.
    ``epsilon_m``: Regularisation at zero compression (m); 0, which stands for its limit, when left out.
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio of both bodies; of the structure alone where the striker's own is given.
    ``stiffness_n_m1_5``: The stiffness itself (N/m^1.5).
    ``striker_material``: Material of the striker, in place of its numbers; a number beside it takes precedence
    ``striker_poissons_ratio``: Poisson's ratio of a striker of another material.
    ``striker_youngs_modulus_pa``: Young's modulus of a striker of another material (Pa).
    ``youngs_modulus_pa``: Young's modulus of both bodies; of the structure alone where the striker's own is given (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("law", "hysteretic")

    theta_m: float
    beta: float
    k_bar: float
    epsilon_m: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    stiffness_n_m1_5: float | None = None
    striker_material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    striker_poissons_ratio: float | None = None
    striker_youngs_modulus_pa: float | None = None
    youngs_modulus_pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class LinearSpring(Part):
    """A linear spring.

    ``stiffness_n_m``: Stiffness (N/m).
    """

    tag: ClassVar[tuple[str, str]] = ("law", "linear-spring")

    stiffness_n_m: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Power(Part):
    """A power of the compression.

    ``stiffness_n_m_n``: Stiffness (N/m^n).
    ``exponent``: Exponent ``n`` of the compression.
    """

    tag: ClassVar[tuple[str, str]] = ("law", "power")

    stiffness_n_m_n: float
    exponent: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Felt(Part):
    """The felt of piano hammers by Stulov's three parameters.

    ``stiffness_n_m_n``: Static stiffness (N/m^n).
    ``exponent``: Exponent ``n`` of the compression, at least 2.
    ``retardation_time_s``: Retardation time (s).
    """

    tag: ClassVar[tuple[str, str]] = ("law", "felt")

    stiffness_n_m_n: float
    exponent: float
    retardation_time_s: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class KelvinVoigt(Part):
    """Spring and dashpot side by side.

    ``stiffness_n_m``: Stiffness (N/m).
    ``damping_n_s_m``: Damping (N s/m), or ``restitution`` in its place.
    ``restitution``: Restitution at a wall, less than 1.
    """

    tag: ClassVar[tuple[str, str]] = ("law", "kelvin-voigt")

    stiffness_n_m: float
    damping_n_s_m: float | None = None
    restitution: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class HuntCrossley(Part):
    """A power of the compression with damping in proportion to it.

    ``damping_s_m``: Damping factor (s/m), or ``restitution`` in its place.
    ``exponent``: Exponent ``n`` of the compression.
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio of both bodies; of the structure alone where the striker's own is given.
    ``restitution``: Restitution at a wall.
    ``stiffness_n_m1_5``: The stiffness itself (N/m^1.5).
    ``stiffness_n_m_n``: Stiffness (N/m^n) that goes with ``exponent``.
    ``striker_material``: Material of the striker, in place of its numbers; a number beside it takes precedence
    ``striker_poissons_ratio``: Poisson's ratio of a striker of another material.
    ``striker_youngs_modulus_pa``: Young's modulus of a striker of another material (Pa).
    ``youngs_modulus_pa``: Young's modulus of both bodies; of the structure alone where the striker's own is given (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("law", "hunt-crossley")

    damping_s_m: float | None = None
    exponent: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    restitution: float | None = None
    stiffness_n_m1_5: float | None = None
    stiffness_n_m_n: float | None = None
    striker_material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    striker_poissons_ratio: float | None = None
    striker_youngs_modulus_pa: float | None = None
    youngs_modulus_pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class LankaraniNikravesh(Part):
    """Hertz contact damped for a restitution near one.

    ``restitution``: Restitution that the damping is meant to give.
    ``lowest_approach_speed_m_s``: Approach speed below which the damping grows no further (m/s); 1e-6 when left out.
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio of both bodies; of the structure alone where the striker's own is given.
    ``stiffness_n_m1_5``: The stiffness itself (N/m^1.5).
    ``striker_material``: Material of the striker, in place of its numbers; a number beside it takes precedence
    ``striker_poissons_ratio``: Poisson's ratio of a striker of another material.
    ``striker_youngs_modulus_pa``: Young's modulus of a striker of another material (Pa).
    ``youngs_modulus_pa``: Young's modulus of both bodies; of the structure alone where the striker's own is given (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("law", "lankarani-nikravesh")

    restitution: float
    lowest_approach_speed_m_s: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    stiffness_n_m1_5: float | None = None
    striker_material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    striker_poissons_ratio: float | None = None
    striker_youngs_modulus_pa: float | None = None
    youngs_modulus_pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Flores(Part):
    """Hertz contact damped for any restitution.

    ``restitution``: Restitution that the damping is meant to give.
    ``lowest_approach_speed_m_s``: Approach speed below which the damping grows no further (m/s); 1e-6 when left out.
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio of both bodies; of the structure alone where the striker's own is given.
    ``stiffness_n_m1_5``: The stiffness itself (N/m^1.5).
    ``striker_material``: Material of the striker, in place of its numbers; a number beside it takes precedence
    ``striker_poissons_ratio``: Poisson's ratio of a striker of another material.
    ``striker_youngs_modulus_pa``: Young's modulus of a striker of another material (Pa).
    ``youngs_modulus_pa``: Young's modulus of both bodies; of the structure alone where the striker's own is given (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("law", "flores")

    restitution: float
    lowest_approach_speed_m_s: float | None = None
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    stiffness_n_m1_5: float | None = None
    striker_material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    striker_poissons_ratio: float | None = None
    striker_youngs_modulus_pa: float | None = None
    youngs_modulus_pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Elastoplastic(Part):
    """Thornton's law.

    ``yield_pressure_pa``: Contact pressure at first yield (Pa), about 1.6 times the yield strength.
    ``material``: Material, in place of its numbers; a number beside it takes precedence
    ``poissons_ratio``: Poisson's ratio of both bodies; of the structure alone where the striker's own is given.
    ``striker_material``: Material of the striker, in place of its numbers; a number beside it takes precedence
    ``striker_poissons_ratio``: Poisson's ratio of a striker of another material.
    ``striker_youngs_modulus_pa``: Young's modulus of a striker of another material (Pa).
    ``youngs_modulus_pa``: Young's modulus of both bodies; of the structure alone where the striker's own is given (Pa).
    """

    tag: ClassVar[tuple[str, str]] = ("law", "elastoplastic")

    yield_pressure_pa: float
    material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    poissons_ratio: float | None = None
    striker_material: Literal["steel", "aluminium", "glass", "rubber", "wood"] | None = None
    striker_poissons_ratio: float | None = None
    striker_youngs_modulus_pa: float | None = None
    youngs_modulus_pa: float | None = None


Contact = Union[
    Hertz,
    Viscous,
    Hysteretic,
    LinearSpring,
    Power,
    Felt,
    KelvinVoigt,
    HuntCrossley,
    LankaraniNikravesh,
    Flores,
    Elastoplastic,
]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Scene(Part):
    """One impact: the structure, the striker, the law of their contact, and the location.

    ``structure``: The struck structure.
    ``striker``: The striker.
    ``contact``: The law of the contact.
    ``description``: A text for the reader; may be left out.
    ``gravity_m_s2``: Acceleration of gravity (m/s^2) for a striker that falls on the structure; 0 when left out. The impact
        then ends with the first flight that rises above the undeflected structure by more than a hundredth of the height of
        the fall, and the restitution is that of a drop test.
    ``location``: Name of the point that is struck. Required for a modal structure with named points; other structures have
        none.
    ``location_m``: Location of the impact (m): from the left end of a beam or string; on a plate two numbers, ``[x, y]``
        from a corner. Required for these; other structures have none.
    ``model``: The model, see; chosen by the program when left out.
    ``modes``: Modes retained, from the lowest: a number (0 is an immovable structure); chosen by the program when left out.
    ``residual_compliance``: Whether remainder modes represent the truncated modes, so that the restitution converges in the
        number of modes. When left out: ``true`` where the program chooses the modes (and knows the static compliance),
        ``false`` where their number is given.
    ``start``: Motion of the structure before the impact; at rest and touched by the striker when left out.
    ``tolerance``: Requested accuracy of the restitution. When left out: 1e-3, which includes truncation, where the program
        chooses the modes; 1e-9, of the solver alone, where the modes are given.
    ``yield_strength_pa``: Yield strength of the softer body (Pa), against which the pressure in the contact is judged; it
        changes no result.
    """

    structure: Structure
    striker: Striker
    contact: Contact
    description: str | None = None
    gravity_m_s2: float | None = None
    location: str | None = None
    location_m: float | Sequence[float] | NDArray[np.float64] | None = None
    model: Literal["auto", "rigid", "infinite-beam", "modal", "emoc"] | None = None
    modes: Literal["auto"] | int | None = None
    residual_compliance: bool | None = None
    start: Start | None = None
    tolerance: float | None = None
    yield_strength_pa: float | None = None
