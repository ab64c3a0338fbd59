//! Checks whether a beam under compression is stable.

use crate::chain::Chain;
use crate::flexure::Flexure;
use crate::rigid::rigid_motions;
use crate::roots::Characteristic;
use invalid_input::InvalidInput;

/// A trial `q = sqrt(omega)` below every natural frequency of a stable beam.
const STILL: f64 = 1e-3;

/// Rejects a compression for which the count of Wittrick and Williams finds a negative square of a frequency; the critical load
/// is the smallest such compression.
pub(crate) fn require_stable(chain: &Chain) -> Result<(), InvalidInput> {
    let rigid = rigid_motions(&chain.spans, chain.ends, &chain.nodes).len();
    let buckled = |tension: f64| {
        let mut spans = chain.spans.clone();
        spans.iter_mut().for_each(|span| span.tension = tension);
        Flexure::new(spans, chain.ends, chain.nodes.clone()).count_and_function(STILL).0 > rigid
    };
    let given = chain.spans[0].tension;
    if !buckled(given) {
        return Ok(());
    }
    let (mut stands, mut fails) = (0.0, given);
    for _ in 0..60 {
        let middle = 0.5 * (stands + fails);
        *(if buckled(middle) { &mut fails } else { &mut stands }) = middle;
    }
    let unit = chain.units.rigidity / chain.units.length_m.powi(2);
    let value = format!("{} (critical load {:.6e} N)", given * unit, stands * unit);
    Err(InvalidInput::new(
        "axial_force_n",
        value,
        "a compression smaller than the critical load, at which the beam buckles",
    ))
}
