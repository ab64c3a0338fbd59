//! A beam system as a dimensionless chain of uniform spans with nodes between them.

use crate::definition::{BeamSystem, End, held};
use crate::location::require_on;
use crate::node::Node;
use crate::span::{Span, Units, nondimensional_beam};
use crate::waves::SHORT;
use invalid_input::InvalidInput;

#[derive(Debug, Clone)]
pub(crate) struct Chain {
    pub spans: Vec<Span>,
    /// One more than the number of spans.
    pub nodes: Vec<Node>,
    pub ends: [End; 2],
    pub units: Units,
}

/// Locations closer than this, relative to the length of the beam, count as one.
const SAME_PLACE: f64 = 1e-12;
/// Largest number of spans into which a beam is divided.
const MOST_SPANS: f64 = 5000.0;
const BESIDE_BENDING: &str =
    "a smaller value, because with this one the beam would have to be divided into more than 5000 segments";
const EULER_BERNOULLI: &str =
    "0 on a Timoshenko beam, because axial force and foundation need Euler-Bernoulli's theory";

impl Chain {
    pub fn of(system: &BeamSystem) -> Result<Self, InvalidInput> {
        let mut chain = Self::nodes_between(system, None)?;
        if system.foundation_n_m2 > 0.0 {
            chain.cut_by_decay(system, |_| true)?;
        }
        Ok(chain)
    }

    /// The same chain without the part of its foundation that is in proportion to the mass per length, and the `omega^2` by
    /// which this part raises the square of every frequency. Where the mass per length is largest, nothing remains. An attached
    /// mass has no foundation below it, so that there the part taken away is a negative spring.
    ///
    /// On a stiff foundation squares of frequencies agree in most digits; those of the remaining chain do not.
    pub fn without_common_foundation(&self) -> (Self, f64) {
        let heaviest = self.spans.iter().map(|span| span.mass).fold(0.0, f64::max);
        let mut chain = self.clone();
        let raised = self.spans[0].foundation / heaviest;
        chain.spans.iter_mut().for_each(|span| span.foundation *= 1.0 - span.mass / heaviest);
        for Node { spring, mass, .. } in &mut chain.nodes {
            (0..2).for_each(|i| spring[i] -= raised * mass[i]);
        }
        (chain, raised)
    }

    /// The [chain without the common part of the foundation](Self::without_common_foundation), divided only in the spans on
    /// which a part of the foundation remains: elsewhere waves propagate at every frequency of a beam that stands.
    pub fn on_rest_of_foundation(system: &BeamSystem) -> Result<(Self, f64), InvalidInput> {
        let (mut chain, raised) = Self::nodes_between(system, None)?.without_common_foundation();
        chain.cut_by_decay(system, |span| span.foundation > 0.0)?;
        Ok((chain, raised))
    }

    /// The chain with a node at `y`, divided so finely that waves do not decay within a span.
    pub fn for_statics(system: &BeamSystem, y: f64) -> Result<Self, InvalidInput> {
        let mut chain = Self::nodes_between(system, Some(y))?;
        chain.cut_by_decay(system, |_| true)?;
        Ok(chain)
    }

    fn nodes_between(system: &BeamSystem, place: Option<f64>) -> Result<Self, InvalidInput> {
        let (mut spans, units) = nondimensional_beam(&system.beam, system.shear.as_deref())?;
        let Units { length_m, rigidity, mass_per_length_kg_m } = units;
        let scaled = |field: &'static str, value: f64, unit: f64| {
            if value.is_finite() && (value * unit).abs() <= 1e18 {
                Ok(value * unit)
            } else {
                let allowed = "a finite number of at most 1e18 times the bending stiffness of the beam";
                Err(InvalidInput::new(field, value, allowed))
            }
        };
        let tension = scaled("axial_force_n", system.axial_force_n, length_m * length_m / rigidity)?;
        let foundation = scaled("foundation_n_m2", system.foundation_n_m2, length_m.powi(4) / rigidity)?;
        for (field, value) in [("axial_force_n", system.axial_force_n), ("foundation_n_m2", system.foundation_n_m2)] {
            if system.shear.is_some() && value != 0.0 {
                return Err(InvalidInput::new(field, value, EULER_BERNOULLI));
            }
        }
        if foundation < 0.0 {
            return Err(InvalidInput::new(
                "foundation_n_m2",
                system.foundation_n_m2,
                "a finite number not less than 0",
            ));
        }
        spans.iter_mut().for_each(|span| (span.tension, span.foundation) = (tension, foundation));

        let mut chain = Self { nodes: vec![Node::default(); spans.len() + 1], spans, ends: system.beam.ends, units };
        let mass = mass_per_length_kg_m * length_m;
        for (i, attachment) in system.attachments.iter().enumerate() {
            let attached = |fault: InvalidInput| fault.at(i).within("attachments");
            let not_negative = |field: &'static str, value: f64, unit: f64| {
                let value = scaled(field, value, unit).map_err(attached)?;
                if value >= 0.0 {
                    Ok(value)
                } else {
                    Err(attached(InvalidInput::new(field, value / unit, "a finite number not less than 0")))
                }
            };
            let node = Node {
                mass: [
                    not_negative("mass_kg", attachment.mass_kg, 1.0 / mass)?,
                    not_negative(
                        "rotary_inertia_kg_m2",
                        attachment.rotary_inertia_kg_m2,
                        1.0 / mass / length_m / length_m,
                    )?,
                ],
                spring: [
                    not_negative("spring_n_m", attachment.spring_n_m, length_m.powi(3) / rigidity)?,
                    not_negative(
                        "rotational_spring_n_m_rad",
                        attachment.rotational_spring_n_m_rad,
                        length_m / rigidity,
                    )?,
                ],
                support: false,
            };
            let x_m = require_on(("attachments", i, "location_m"), attachment.location_m, length_m)?;
            chain.node_at(x_m / length_m).add(&node);
        }
        for (i, support) in system.supports.iter().enumerate() {
            let x = require_on(("supports", i, "location_m"), support.location_m, length_m)? / length_m;
            chain.node_at(x).support = true;
        }
        if let Some(x) = place {
            chain.node_at(x);
        }
        // A support at an end is a boundary condition.
        let last = chain.spans.len();
        for (end, node) in [(0, 0), (1, last)] {
            if std::mem::take(&mut chain.nodes[node].support) {
                chain.ends[end] = held(chain.ends[end]);
            }
        }
        Ok(chain)
    }

    /// The node at a location; the span is divided there if there is none.
    fn node_at(&mut self, x: f64) -> &mut Node {
        let i = self.index(x);
        &mut self.nodes[i]
    }

    fn index(&mut self, x: f64) -> usize {
        let (i, inside) = crate::span::locate(&self.spans, x);
        let span = self.spans[i];
        if inside <= SAME_PLACE {
            return i;
        }
        if span.length - inside <= SAME_PLACE {
            return i + 1;
        }
        self.spans[i].length = inside;
        self.spans.insert(i + 1, Span { start: span.start + inside, length: span.length - inside, ..span });
        self.nodes.insert(i + 1, Node::default());
        i + 1
    }

    /// Divides those of the chosen spans in which axial force or foundation cause decaying waves.
    fn cut_by_decay(&mut self, system: &BeamSystem, chosen: impl Fn(&Span) -> bool) -> Result<(), InvalidInput> {
        let pieces = |span: &Span| {
            if !chosen(span) {
                return 1.0;
            }
            let by_force = (span.tension.abs() / span.rigidity).sqrt();
            let by_foundation = (2.0 * span.foundation / span.rigidity).sqrt().sqrt();
            (span.length * (by_force + by_foundation) / (0.7 * SHORT)).ceil().max(1.0)
        };
        if self.spans.iter().map(pieces).sum::<f64>() > MOST_SPANS {
            let (field, value) = match system.foundation_n_m2 > 0.0 {
                true => ("foundation_n_m2", system.foundation_n_m2),
                false => ("axial_force_n", system.axial_force_n),
            };
            return Err(InvalidInput::new(field, value, BESIDE_BENDING));
        }
        let (mut spans, mut nodes) = (Vec::new(), Vec::new());
        for (span, node) in self.spans.iter().zip(&self.nodes) {
            let n = pieces(span);
            for i in 0..n as usize {
                let start = span.start + span.length * i as f64 / n;
                spans.push(Span { start, length: span.length / n, ..*span });
                nodes.push(if i == 0 { *node } else { Node::default() });
            }
        }
        nodes.extend(self.nodes.last());
        (self.spans, self.nodes) = (spans, nodes);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Beam, Segment};

    /// Only where the mass per length is smaller than elsewhere does a part of the foundation remain, and divide the span.
    #[test]
    fn a_stiff_foundation_divides_light_spans_alone() {
        let spans = |masses: &[f64]| {
            let segment =
                |mass: &f64| Segment { length_m: 0.5, flexural_rigidity_n_m2: 1.0, mass_per_length_kg_m: *mass };
            let beam = Beam { segments: masses.iter().map(segment).collect(), ends: [End::Pinned; 2] };
            let system = BeamSystem { foundation_n_m2: 1e9, ..beam.into() };
            Chain::on_rest_of_foundation(&system).unwrap().0.spans
        };
        assert_eq!(spans(&[1.0, 1.0]).len(), 1);
        let stepped = spans(&[1.0, 0.6]);
        assert!(stepped.len() > 10 && stepped[1].start == 0.5, "{}", stepped.len());
    }
}
