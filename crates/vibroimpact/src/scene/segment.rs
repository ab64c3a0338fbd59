//! A uniform segment of a beam, and its rigidity and mass by either theory of bending.

use std::f64::consts::PI;

use beam_modes::RectangularSegment;
use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::require_positive;
use super::extreme::{follows_from, require_product};
use super::fields;
use super::json::number;
use super::sets::one_of_sets;

/// A uniform piece of a beam: its length, and its section in one of three ways: flexural rigidity and mass per
/// length; material, width and thickness; or material and diameter. Timoshenko's theory also needs shear rigidity and
/// rotary inertia in the first way, Poisson's ratio in the others.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// Length (m).
    pub length_m: f64,
    /// Flexural rigidity `EI` (N m^2).
    pub flexural_rigidity_n_m2: Option<f64>,
    /// Mass per length (kg/m).
    pub mass_per_length_kg_m: Option<f64>,
    /// Young's modulus (Pa).
    pub youngs_modulus_pa: Option<f64>,
    /// Density (kg/m^3).
    pub density_kg_m3: Option<f64>,
    /// Width of a rectangular section, across the direction of the impact (m).
    pub width_m: Option<f64>,
    /// Thickness of a rectangular section, in the direction of the impact (m).
    pub thickness_m: Option<f64>,
    /// Diameter of a circular section (m).
    pub diameter_m: Option<f64>,
    /// Poisson's ratio, for Timoshenko's theory: it gives the shear modulus and the shear coefficient.
    pub poissons_ratio: Option<f64>,
    /// Shear coefficient `kappa` of Timoshenko's theory. When left out: `5(1+nu)/(6+5nu)` for a rectangle,
    /// `6(1+nu)^2/(7+12nu+4nu^2)` for a circle, which follow elasticity better than Cowper's.
    pub shear_coefficient: Option<f64>,
    /// Shear rigidity `kappa G A` (N), beside the flexural rigidity.
    pub shear_rigidity_n: Option<f64>,
    /// Rotary inertia per length `rho I` (kg m), beside the flexural rigidity.
    pub rotary_inertia_kg_m: Option<f64>,
}

/// The ways in which a section is given.
pub(super) const SECTIONS: [&[&str]; 3] = [
    &["flexural_rigidity_n_m2", "mass_per_length_kg_m"],
    &["youngs_modulus_pa", "density_kg_m3", "width_m", "thickness_m"],
    &["youngs_modulus_pa", "density_kg_m3", "diameter_m"],
];

/// Of a rectangle (T. Kaneko, J. Phys. D 8:1927, 1975, reviews both).
fn rectangle_coefficient(nu: f64) -> f64 {
    5.0 * (1.0 + nu) / (6.0 + 5.0 * nu)
}

/// Of a circle.
fn circle_coefficient(nu: f64) -> f64 {
    6.0 * (1.0 + nu).powi(2) / (7.0 + 12.0 * nu + 4.0 * nu * nu)
}

/// How a section is given.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Section {
    Direct,
    /// Width and thickness.
    Rectangle([f64; 2]),
    Circle(f64),
}

impl From<RectangularSegment> for Segment {
    /// A piece of rectangular section.
    fn from(piece: RectangularSegment) -> Segment {
        let RectangularSegment { length_m, youngs_modulus_pa, density_kg_m3, width_m, thickness_m } = piece;
        Segment {
            length_m,
            youngs_modulus_pa: Some(youngs_modulus_pa),
            density_kg_m3: Some(density_kg_m3),
            width_m: Some(width_m),
            thickness_m: Some(thickness_m),
            ..Segment::default()
        }
    }
}

impl Segment {
    /// A piece of circular section: length, material and diameter in SI units.
    pub fn circular(length_m: f64, youngs_modulus_pa: f64, density_kg_m3: f64, diameter_m: f64) -> Segment {
        Segment {
            length_m,
            youngs_modulus_pa: Some(youngs_modulus_pa),
            density_kg_m3: Some(density_kg_m3),
            diameter_m: Some(diameter_m),
            ..Segment::default()
        }
    }

    fn section(&self) -> Result<Section, InvalidInput> {
        let given = [
            ("flexural_rigidity_n_m2", self.flexural_rigidity_n_m2),
            ("mass_per_length_kg_m", self.mass_per_length_kg_m),
            ("youngs_modulus_pa", self.youngs_modulus_pa),
            ("density_kg_m3", self.density_kg_m3),
            ("width_m", self.width_m),
            ("thickness_m", self.thickness_m),
            ("diameter_m", self.diameter_m),
        ];
        let set = one_of_sets(&given, &SECTIONS)?;
        for (field, value) in std::iter::once(("length_m", Some(self.length_m))).chain(given) {
            value.map_or(Ok(()), |value| require_positive(field, value))?;
        }
        let [width, thickness, diameter] =
            [self.width_m, self.thickness_m, self.diameter_m].map(Option::unwrap_or_default);
        Ok(match set {
            0 => Section::Direct,
            1 => Section::Rectangle([width, thickness]),
            _ => Section::Circle(diameter),
        })
    }

    /// Bending and mass.
    pub(super) fn to_segment(self) -> Result<beam_modes::Segment, InvalidInput> {
        let section = self.section()?;
        let length_m = self.length_m;
        let [modulus, density] = [self.youngs_modulus_pa, self.density_kg_m3].map(Option::unwrap_or_default);
        let (piece, sizes) = match section {
            Section::Direct => {
                return Ok(beam_modes::Segment {
                    length_m,
                    flexural_rigidity_n_m2: self.flexural_rigidity_n_m2.unwrap_or_default(),
                    mass_per_length_kg_m: self.mass_per_length_kg_m.unwrap_or_default(),
                });
            }
            Section::Rectangle([width, thickness]) => {
                let piece = RectangularSegment {
                    length_m,
                    youngs_modulus_pa: modulus,
                    density_kg_m3: density,
                    width_m: width,
                    thickness_m: thickness,
                };
                (beam_modes::Segment::from(piece), vec![("width_m", width), ("thickness_m", thickness)])
            }
            Section::Circle(diameter) => {
                let piece = beam_modes::Segment {
                    length_m,
                    flexural_rigidity_n_m2: modulus * PI * diameter.powi(4) / 64.0,
                    mass_per_length_kg_m: density * PI * diameter.powi(2) / 4.0,
                };
                (piece, vec![("diameter_m", diameter)])
            }
        };
        let with = |field, value| [&[(field, value)], &sizes[..]].concat();
        let rigidity = with("youngs_modulus_pa", modulus);
        require_product("flexural rigidity", piece.flexural_rigidity_n_m2, &rigidity)?;
        require_product("mass per length", piece.mass_per_length_kg_m, &with("density_kg_m3", density))?;
        Ok(piece)
    }

    /// The error of a property of the section as that of a field from which it follows; `None` if the segment gives it.
    pub(super) fn in_given_fields(&self, fault: &InvalidInput) -> Option<InvalidInput> {
        let by_modulus = ("youngs_modulus_pa", self.youngs_modulus_pa);
        let by_density = ("density_kg_m3", self.density_kg_m3);
        let (quantity, material) = match fault.field.last() {
            Some("flexural_rigidity_n_m2") => ("flexural rigidity", by_modulus),
            Some("shear_rigidity_n") => ("shear rigidity", by_modulus),
            Some("mass_per_length_kg_m") => ("mass per length", by_density),
            Some("rotary_inertia_kg_m") => ("rotary inertia", by_density),
            _ => return None,
        };
        let sizes = [("width_m", self.width_m), ("thickness_m", self.thickness_m), ("diameter_m", self.diameter_m)];
        let given = [material].into_iter().chain(sizes);
        let fields: Vec<(&str, f64)> = given.filter_map(|(field, value)| Some((field, value?))).collect();
        follows_from(quantity, fault, &fields)
    }

    /// Shear and rotary inertia, or `None` if neither is given.
    pub(super) fn to_shear(self) -> Result<Option<beam_modes::ShearSection>, InvalidInput> {
        let section = self.section()?;
        let given = [
            ("poissons_ratio", self.poissons_ratio),
            ("shear_coefficient", self.shear_coefficient),
            ("shear_rigidity_n", self.shear_rigidity_n),
            ("rotary_inertia_kg_m", self.rotary_inertia_kg_m),
        ];
        let (own, others) = match section {
            Section::Direct => ([2, 3], [0, 1]),
            Section::Rectangle(_) | Section::Circle(_) => ([0, 1], [2, 3]),
        };
        for (field, value) in others.map(|i| given[i]) {
            if let Some(value) = value {
                let allowed = match section {
                    Section::Direct => {
                        "left out in the presence of flexural_rigidity_n_m2, because shear is then given by shear_rigidity_n and \
                         rotary_inertia_kg_m"
                    }
                    _ => {
                        "left out in the presence of a section, because shear is then given by poissons_ratio and, optionally, \
                         shear_coefficient"
                    }
                };
                return Err(InvalidInput::new(field, number(value), allowed));
            }
        }
        let [first, second] = own.map(|i| given[i].1);
        if first.is_none() && second.is_none() {
            return Ok(None);
        }
        let missing = |field: &str| InvalidInput::missing(field, fields::allowed(field).unwrap_or_default());
        if section == Section::Direct {
            let shear_rigidity_n = first.ok_or_else(|| missing("shear_rigidity_n"))?;
            let rotary_inertia_kg_m = second.ok_or_else(|| missing("rotary_inertia_kg_m"))?;
            require_positive("shear_rigidity_n", shear_rigidity_n)?;
            return Ok(Some(beam_modes::ShearSection { shear_rigidity_n, rotary_inertia_kg_m }));
        }
        let nu = first.ok_or_else(|| missing("poissons_ratio"))?;
        if !(nu > -1.0 && nu <= 0.5) {
            let allowed = fields::allowed("poissons_ratio").unwrap_or_default();
            return Err(InvalidInput::new("poissons_ratio", number(nu), allowed));
        }
        if let Some(coefficient) = second.filter(|c| !(*c > 0.0 && *c <= 2.0)) {
            let allowed = fields::allowed("shear_coefficient").unwrap_or_default();
            return Err(InvalidInput::new("shear_coefficient", number(coefficient), allowed));
        }
        let [modulus, density] = [self.youngs_modulus_pa, self.density_kg_m3].map(Option::unwrap_or_default);
        let (area, second_moment, coefficient) = match section {
            Section::Rectangle([width, thickness]) => {
                (width * thickness, width * thickness.powi(3) / 12.0, rectangle_coefficient(nu))
            }
            Section::Circle(diameter) => {
                (PI * diameter.powi(2) / 4.0, PI * diameter.powi(4) / 64.0, circle_coefficient(nu))
            }
            Section::Direct => return Ok(None),
        };
        let shear_modulus = modulus / (2.0 * (1.0 + nu));
        Ok(Some(beam_modes::ShearSection {
            shear_rigidity_n: second.unwrap_or(coefficient) * shear_modulus * area,
            rotary_inertia_kg_m: density * second_moment,
        }))
    }

    /// The error for missing data of shear.
    pub(super) fn lacks_shear(&self) -> InvalidInput {
        let field = if self.flexural_rigidity_n_m2.is_some() { "shear_rigidity_n" } else { "poissons_ratio" };
        let range = fields::allowed(field).unwrap_or_default();
        InvalidInput::missing(field, format!("{range}, because the theory timoshenko needs it"))
    }

    /// The same segment with its shear rigidity multiplied by this factor.
    pub(super) fn with_shear_times(self, factor: f64) -> Segment {
        let by_section = self
            .poissons_ratio
            .map(|nu| if self.diameter_m.is_some() { circle_coefficient(nu) } else { rectangle_coefficient(nu) });
        Segment {
            shear_coefficient: self.shear_coefficient.or(by_section).map(|coefficient| factor * coefficient),
            shear_rigidity_n: self.shear_rigidity_n.map(|rigidity| factor * rigidity),
            ..self
        }
    }

    /// The extent in the direction of the impact, if the section has one, with its field.
    pub(crate) fn thickness(&self) -> Option<(&'static str, f64)> {
        self.thickness_m.map(|h| ("thickness_m", h)).or(self.diameter_m.map(|d| ("diameter_m", d)))
    }
}
