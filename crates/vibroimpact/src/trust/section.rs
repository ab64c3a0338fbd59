//! Waves in the structure at the location of impact: the wavelength for a frequency.

use std::f64::consts::PI;

use crate::scene::{BeamTheory, InvalidInput, Location, PlateTheory, Scene, Structure};

/// The section of a beam or plate at the location of impact.
pub(super) struct Section {
    pub thickness_m: f64,
    /// Distance to the nearest end, edge, support or step, if there is one.
    pub clearance_m: Option<f64>,
    /// Flexural rigidity `EI` (per width for a plate), and mass per length or area.
    rigidity: f64,
    mass: f64,
    /// Shear rigidity and rotary inertia (per width for a plate), if the theory has them.
    shear: Option<[f64; 2]>,
}

/// Limits of half the wavelength over the thickness: within the theory's range, and outside it.
const SLENDER: [f64; 2] = [6.0, 2.2];
const WITH_SHEAR: [f64; 2] = [0.5, 0.25];

impl Section {
    pub fn limits(&self) -> [f64; 2] {
        if self.shear.is_some() { WITH_SHEAR } else { SLENDER }
    }

    /// Name of the theory.
    pub fn theory(&self) -> &'static str {
        if self.shear.is_some() { "bending with shear" } else { "slender bending" }
    }

    /// Half the wavelength of bending waves (m): the larger root of
    /// `EI k^4 - (J + m EI/S) w^2 k^2 + (m J/S) w^4 - m w^2 = 0`, with `J = 1/S = 0` without shear.
    pub fn half_wavelength_m(&self, omega_rad_s: f64) -> f64 {
        let square = omega_rad_s * omega_rad_s;
        let [compliance, inertia] = self.shear.map_or([0.0; 2], |[shear, inertia]| [1.0 / shear, inertia]);
        let middle = (inertia + self.mass * self.rigidity * compliance) * square;
        let last = self.mass * square * (inertia * compliance * square - 1.0);
        let root = (middle + (middle * middle - 4.0 * self.rigidity * last).max(0.0).sqrt()) / (2.0 * self.rigidity);
        PI / root.sqrt()
    }

    /// The frequency at which half the wavelength is this multiple of the thickness (rad/s).
    pub fn frequency_rad_s(&self, ratio: f64) -> f64 {
        // the wavelength falls with the frequency; without shear the closed form, which is an upper bound with it
        let k = PI / (ratio * self.thickness_m);
        let mut high = k * k * (self.rigidity / self.mass).sqrt();
        let mut low = 0.0;
        if self.shear.is_none() {
            return high;
        }
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            *(if self.half_wavelength_m(middle) * k > PI { &mut low } else { &mut high }) = middle;
        }
        low
    }
}

/// The section at the location of impact of a scene; `None` if it has no thickness.
pub(super) fn section(scene: &Scene) -> Result<Option<Section>, InvalidInput> {
    let plate = |rigidity: f64, density: f64, thickness_m: f64, shear: Option<[f64; 2]>| {
        Some(Section { thickness_m, clearance_m: None, rigidity, mass: density * thickness_m, shear })
    };
    Ok(match &scene.structure {
        Structure::Beam(beam) => {
            let place = scene.location_m.map_or(Ok(0.0), |place| place.along())?;
            let system = beam.to_system().map_err(|fault| fault.within("structure"))?;
            let supports = beam.supports.iter().map(|support| support.location_m);
            let ends = beam.segments.iter().scan(0.0, |end_m, segment| {
                *end_m += segment.length_m;
                Some(*end_m)
            });
            let clearance_m = nearest(place, supports.chain(ends).chain([0.0]));
            let mut end_m = 0.0;
            let here = system.beam.segments.iter().position(|segment| {
                end_m += segment.length_m;
                end_m >= place
            });
            let here = here.unwrap_or(system.beam.segments.len().saturating_sub(1));
            let (segment, bending) = (&beam.segments[here], &system.beam.segments[here]);
            let shear = match (beam.solved_by(), &system.shear) {
                (Ok(BeamTheory::Timoshenko), Some(shear)) => Some(shear[here]),
                _ => None,
            };
            // the thickness of a rectangle with this rotary inertia
            let by_inertia = shear.map(|s| (12.0 * s.rotary_inertia_kg_m / bending.mass_per_length_kg_m).sqrt());
            let thickness_m = segment.thickness().map(|(_, thickness_m)| thickness_m).or(by_inertia);
            thickness_m.filter(|thickness| *thickness > 0.0).map(|thickness_m| Section {
                thickness_m,
                clearance_m,
                rigidity: bending.flexural_rigidity_n_m2,
                mass: bending.mass_per_length_kg_m,
                shear: shear.map(|s| [s.shear_rigidity_n, s.rotary_inertia_kg_m]),
            })
        }
        Structure::Plate(described) => {
            let solved = described.to_plate().map_err(|fault| fault.within("structure"))?;
            let h = described.thickness_m;
            let shear = match solved.theory {
                beam_modes::PlateTheory::Mindlin { shear_coefficient } if described.theory == PlateTheory::Mindlin => {
                    let modulus = 0.5 * described.youngs_modulus_pa / (1.0 + described.poissons_ratio);
                    Some([shear_coefficient * modulus * h, described.density_kg_m3 * h.powi(3) / 12.0])
                }
                _ => None,
            };
            let clearance_m = match scene.location_m {
                Some(Location::On([x, y])) => {
                    [nearest(x, [0.0, described.length_m]), nearest(y, [0.0, described.width_m])]
                        .into_iter()
                        .flatten()
                        .reduce(f64::min)
                }
                _ => None,
            };
            plate(solved.flexural_rigidity_n_m(), described.density_kg_m3, h, shear)
                .map(|section| Section { clearance_m, ..section })
        }
        Structure::DroppedRod(rod) => {
            let d = rod.diameter_m;
            let area_m2 = 0.25 * PI * d * d;
            let rigidity = rod.youngs_modulus_pa * area_m2 * d * d / 16.0;
            Some(Section {
                thickness_m: d,
                clearance_m: None,
                rigidity,
                mass: rod.density_kg_m3 * area_m2,
                shear: None,
            })
        }
        Structure::InfiniteBeam(beam) => {
            let thickness_m = beam.thickness_m.or(beam.diameter_m);
            let bending = beam.section().map_err(|fault| fault.within("structure"))?;
            thickness_m.map(|thickness_m| Section {
                thickness_m,
                clearance_m: None,
                rigidity: bending.flexural_rigidity_n_m2,
                mass: bending.mass_per_length_kg_m,
                shear: None,
            })
        }
        Structure::InfinitePlate(described) => {
            let (h, nu) = (described.thickness_m, described.poissons_ratio);
            let rigidity = described.youngs_modulus_pa * h.powi(3) / (12.0 * (1.0 - nu * nu));
            plate(rigidity, described.density_kg_m3, h, None)
        }
        Structure::TautString(_) | Structure::Modal(_) | Structure::ModesFile(_) => None,
    })
}

/// The distance to the nearest of some locations.
fn nearest(here: f64, places: impl IntoIterator<Item = f64>) -> Option<f64> {
    places.into_iter().map(|place| (place - here).abs()).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use beam_modes::{Beam, BeamSystem, End, RectangularSegment, Segment, ShearSection};

    /// Modes of pinned beams are sines, whatever the theory: mode `n` has `n` half waves.
    #[test]
    fn modes_of_pinned_beams_have_whole_half_waves() {
        let (h, modulus, density, length_m): (f64, f64, f64, f64) = (0.02, 2e11, 7800.0, 1.3);
        let segment = Segment::from(RectangularSegment {
            length_m,
            youngs_modulus_pa: modulus,
            density_kg_m3: density,
            width_m: h,
            thickness_m: h,
        });
        let shear = [0.85 * modulus / 2.6 * h * h, density * h.powi(4) / 12.0];
        let slender = BeamSystem::from(Beam { segments: vec![segment], ends: [End::Pinned; 2] });
        let sections = ShearSection { shear_rigidity_n: shear[0], rotary_inertia_kg_m: shear[1] };
        let thick = BeamSystem { shear: Some(vec![sections]), ..slender.clone() };
        for (beam, shear) in [(slender, None), (thick, Some(shear))] {
            let (rigidity, mass) = (segment.flexural_rigidity_n_m2, segment.mass_per_length_kg_m);
            let section = Section { thickness_m: h, clearance_m: None, rigidity, mass, shear };
            // up to the cut-off, beyond which the second spectrum joins
            for (n, omega) in beam.modes(40).unwrap().omega_rad_s().iter().enumerate() {
                let exact = length_m / (n + 1) as f64;
                let found = section.half_wavelength_m(*omega);
                assert!((found / exact - 1.0).abs() < 1e-9, "{n}: {found} {exact}");
                assert!((section.frequency_rad_s(exact / h) / omega - 1.0).abs() < 1e-9, "{n}");
            }
        }
    }

    /// The basis of the limits: Euler-Bernoulli's frequencies compared with Timoshenko's at half waves of 6 and of 2.2 thicknesses.
    #[test]
    fn slender_bending_is_off_by_five_and_by_a_quarter_at_its_limits() {
        let (h, modulus, density): (f64, f64, f64) = (0.011323, 2e11, 7800.0);
        let (rigidity, mass) = (modulus * h.powi(4) / 12.0, density * h * h);
        let shear = Some([0.85 * modulus / 2.6 * h * h, density * h.powi(4) / 12.0]);
        let [slender, thick] =
            [None, shear].map(|shear| Section { thickness_m: h, clearance_m: None, rigidity, mass, shear });
        let excess = |ratio: f64| slender.frequency_rad_s(ratio) / thick.frequency_rad_s(ratio) - 1.0;
        let [within, outside] = SLENDER.map(excess);
        assert!((within - 0.05).abs() < 0.01 && (outside - 0.27).abs() < 0.04, "{within} {outside}");
    }

    /// The basis of the first limit with shear: Timoshenko's second spectrum compared with the second antisymmetric wave of an
    /// elastic strip in plane stress (Rayleigh 1889, Lamb 1917), where it begins and where half waves of the first spectrum have
    /// the limit.
    #[test]
    fn the_second_spectrum_is_too_fast_by_three_to_five_per_cent_up_to_the_limit_with_shear() {
        // half the thickness, the speed of shear waves and the density are 1
        let nu = 0.3_f64;
        let (rigidity, mass, inertia) = (4.0 / 3.0 * (1.0 + nu), 2.0, 2.0 / 3.0);
        let shear = 2.0 * 5.0 * (1.0 + nu) / (6.0 + 5.0 * nu);
        let section = Section { thickness_m: 2.0, clearance_m: None, rigidity, mass, shear: Some([shear, inertia]) };
        let cut_off = (shear / inertia).sqrt();
        let begins = section.half_wavelength_m(cut_off) / section.thickness_m;
        assert!((begins - 0.785).abs() < 1e-3, "{begins}");
        let limit = section.frequency_rad_s(WITH_SHEAR[0]);
        assert!((limit / cut_off - 1.70).abs() < 0.01, "{}", limit / cut_off);

        // the other root of the equation of the half wavelength, whose sum with the first is its middle coefficient
        let second_k2 = |omega: f64| {
            let first_k = PI / section.half_wavelength_m(omega);
            (inertia / rigidity + mass / shear) * omega * omega - first_k * first_k
        };
        let elastic = |omega: f64, k2: f64| {
            let (p, q) = ((0.5 * omega * omega * (1.0 - nu) - k2).sqrt(), (omega * omega - k2).sqrt());
            (q * q - k2).powi(2) * p.sin() / p * q.cos() + 4.0 * k2 * q * p.cos() * q.sin()
        };
        for (omega, expected) in [(cut_off, 0.0265), (limit, 0.0447)] {
            let k2 = second_k2(omega).max(0.0);
            let (mut low, mut high) = (0.9 * omega, omega);
            assert!(elastic(low, k2) * elastic(high, k2) < 0.0, "{omega}");
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                *(if elastic(middle, k2) * elastic(high, k2) > 0.0 { &mut high } else { &mut low }) = middle;
            }
            let excess = omega / low - 1.0;
            assert!((excess - expected).abs() < 1e-3, "{omega}: {excess}");
        }
    }
}
