//! The elastic modes of a beam: in closed form if it is uniform and nothing is attached to it, by the count and a search otherwise.

use crate::flexure::Flexure;
use crate::piece::Piece;
use crate::roots::elastic_roots;
use crate::shapes::shapes;
use crate::standing::standing_waves;
use crate::uniform;
use invalid_input::InvalidInput;

/// Elastic modes in ascending order, dimensionless.
#[derive(Default)]
pub(crate) struct Elastic {
    pub omega: Vec<f64>,
    /// The pieces of each mode, span by span.
    pub shapes: Vec<Vec<Piece>>,
}

impl Elastic {
    /// `wanted` modes above the first `below` ones, which are rigid-body motions unless the beam buckles.
    pub fn of(guide: &Flexure, below: usize, wanted: usize) -> Result<Elastic, InvalidInput> {
        if let Some((span, ends)) = guide.uniform()
            && let Some(waves) = standing_waves(span, ends, wanted)
        {
            let (omega, shapes) = waves.into_iter().map(|(omega, shape)| (omega, vec![shape])).unzip();
            return Ok(Elastic { omega, shapes });
        }
        let closed = guide.uniform().filter(|(span, _)| span.is_plain());
        let roots = match closed.and_then(|(span, ends)| uniform::roots(span, ends, wanted)) {
            Some(roots) => roots,
            None => elastic_roots(guide, below, wanted)?,
        };
        Ok(Elastic { omega: roots.iter().map(|q| q * q).collect(), shapes: shapes(guide, &roots) })
    }

    /// Adds the modes of a chain whose foundation was reduced by `raised`.
    pub fn add(&mut self, guide: &Flexure, below: usize, wanted: usize, raised: f64) -> Result<(), InvalidInput> {
        let Elastic { omega, shapes } = Elastic::of(guide, below, wanted)?;
        self.omega.extend(omega.iter().map(|omega| omega.hypot(raised.sqrt())));
        self.shapes.extend(shapes);
        Ok(())
    }
}
