//! From the derivatives of a run to those of the outputs of a scene.

use vibroimpact_sim::modal::NoDerivative;

use super::modes::Modes;
use super::neighbours::Around;
use super::refusal::Refusal;
use super::table::{Output, Table};
use crate::scene::InvalidInput;

/// The table of the derivatives with respect to all fields, which are followed by those with respect to the draws of the modes'
/// errors. A field without derivatives is left out, unless the user named it; `modal` returns the outputs of the modes for a field.
pub(super) fn collect<T, D>(
    around: &Around<T>,
    modes: &Modes,
    derivatives: &[Result<D, NoDerivative>],
    outputs: impl Fn(&D) -> Vec<Output>,
    modal: impl Fn(usize) -> Vec<Output>,
    refusal: impl Fn(NoDerivative) -> Refusal,
) -> Result<Table, InvalidInput> {
    let (of_fields, of_draws) = derivatives.split_at(around.near.len());
    // of the reasons, only this one lies in the field
    if let Some(Err(why)) = of_fields.first()
        && *why != NoDerivative::Split
        && of_fields.iter().all(Result::is_err)
    {
        return Err(refusal(*why).error(None));
    }
    let draws: Vec<Option<Vec<Output>>> = of_draws.iter().map(|draw| draw.as_ref().ok().map(&outputs)).collect();
    let mut table = Table::new(around.left_out.clone());
    for (i, (near, found)) in around.near.iter().zip(of_fields).enumerate() {
        match found {
            Ok(found) => {
                let widened = outputs(found).into_iter().enumerate().map(|(k, output)| {
                    let effect = |draw: &Option<Vec<Output>>| Some(draw.as_ref()?.get(k)?.derivative.value);
                    let effects: Vec<Option<f64>> = draws.iter().map(effect).collect();
                    Output { derivative: modes.widened(i, output.derivative, &effects), ..output }
                });
                table.add(&near.field, near.value, widened.chain(modal(i)).collect());
            }
            Err(why) if around.named => return Err(refusal(*why).error(Some(&near.field))),
            Err(why) => table.leave_out(&near.field, refusal(*why).happens),
        }
    }
    Ok(table)
}
