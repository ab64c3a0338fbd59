//! Waves of bending along a beam: on average, the frequency of mode `n` is that at which `n` half waves fit into the beam.

use std::f64::consts::PI;

use beam_modes::Segment;
use invalid_input::InvalidInput;

use super::beam::Beam;

/// Locations closer to each other than this share of the length coincide.
const COINCIDES: f64 = 1e-12;

/// The waves of a beam, seen from a location.
pub(crate) struct Waves {
    /// `sum l (m'/EI)^(1/4)`, the phase of the whole beam at the frequency 1 rad/s.
    phase: f64,
    /// The segment at the location, of two the left one.
    here: Segment,
    /// Distance (m) of the nearest end, step, support or attachment, where waves are reflected. The location itself does not count.
    reflection_m: f64,
}

fn slowness(segment: &Segment) -> f64 {
    (segment.mass_per_length_kg_m / segment.flexural_rigidity_n_m2).powf(0.25)
}

impl Waves {
    /// `None` for a beam without segments.
    ///
    /// # Errors
    /// As [`Beam::to_beam`].
    pub fn new(beam: &Beam, location_m: f64) -> Result<Option<Waves>, InvalidInput> {
        let segments = beam.to_beam()?.segments;
        let (mut length_m, mut here) = (0.0, None);
        let attached_m = beam.attachments.iter().map(|attachment| attachment.location_m);
        let mut reflections_m: Vec<f64> =
            beam.supports.iter().map(|support| support.location_m).chain(attached_m).collect();
        reflections_m.push(0.0);
        for (i, segment) in segments.iter().enumerate() {
            length_m += segment.length_m;
            if length_m >= location_m {
                here.get_or_insert(*segment);
            }
            let continues = |next: &Segment| Segment { length_m: segment.length_m, ..*next } == *segment;
            if !segments.get(i + 1).is_some_and(continues) {
                reflections_m.push(length_m);
            }
        }
        let distances_m = reflections_m.iter().map(|place_m| (place_m - location_m).abs());
        let reflection_m =
            distances_m.filter(|distance_m| *distance_m > COINCIDES * length_m).fold(f64::INFINITY, f64::min);
        let phase = segments.iter().map(|segment| segment.length_m * slowness(segment)).sum();
        Ok(here.or(segments.last().copied()).map(|here| Waves { phase, here, reflection_m }))
    }

    /// Expected frequency of mode `n` (rad/s), and the contribution of the modes up to it to the inverse mass at the location
    /// (1/kg): the modes up to the wave number `k` have the mean density `1/(pi m')` in `k`.
    pub fn expected(&self, n: usize) -> (f64, f64) {
        let root = n as f64 * PI / self.phase;
        (root * root, root * slowness(&self.here) / (PI * self.here.mass_per_length_kg_m))
    }

    /// Number of the mode of which half a wave fits between the location and the nearest reflection.
    pub fn resolving_reflection(&self) -> f64 {
        self.phase / (slowness(&self.here) * self.reflection_m)
    }
}

#[cfg(test)]
mod tests {
    use super::super::beam::End;
    use super::super::fittings::Support;
    use super::*;
    use beam_modes::RectangularSegment;

    #[test]
    fn reflections_are_ends_steps_supports_and_attachments() {
        let segment = |length_m: f64, thickness_m: f64| {
            RectangularSegment { length_m, youngs_modulus_pa: 2e11, density_kg_m3: 7800.0, width_m: 0.01, thickness_m }
                .into()
        };
        let mut beam = Beam::new([End::Pinned; 2]);
        let half_waves =
            |beam: &Beam, location_m: f64| Waves::new(beam, location_m).unwrap().unwrap().resolving_reflection();
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
        beam.segments = vec![segment(0.5, 0.01), segment(0.5, 0.01)];
        // no step, and at an end the other end
        near(half_waves(&beam, 0.501), 1.0 / 0.499);
        near(half_waves(&beam, 0.0), 1.0);
        // of a quarter of the thickness: waves are twice as slow
        beam.segments[1] = segment(0.5, 0.0025);
        near(half_waves(&beam, 0.499), 1.5 / 0.001);
        near(half_waves(&beam, 0.501), 0.75 / 0.001);
        near(half_waves(&beam, 0.5), 3.0);
        beam.supports = vec![Support { location_m: 0.1 }];
        near(half_waves(&beam, 0.11), 1.5 / 0.01);
    }
}
