//! Chapter 7: EMOC fitted to the tables of both theories.

use super::tables::Tables;
use crate::chapters::chapter7::{Dataset, LAW_MODES, failure::irregularity, fits::BeamFit};
use crate::chapters::study::Study;
use tasks::Failure;
use vibroimpact::net;
use vibroimpact::report::significant;

/// Root mean square of some of the residuals.
fn rms(residuals: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = residuals.fold((0.0, 0.0), |(sum, count), r| (sum + r * r, count + 1.0));
    (sum / count).sqrt()
}

pub(super) fn run(study: &mut Study, tables: &Tables) -> Result<(), Failure> {
    study.section("The fit of EMOC (chapter 7)");
    let (mut lines, mut other) = (Vec::new(), Vec::new());
    for k in 0..tables.thick.len() {
        let data = [&tables.truncated[k], &tables.slender[k], &tables.thick[k]].map(Dataset::new);
        let fits = data.iter().map(|data| BeamFit::new(data, LAW_MODES)).collect::<Result<Vec<BeamFit>, Failure>>()?;
        for ((name, data), found) in
            ["N = 40, as in the thesis", "Euler-Bernoulli", "Timoshenko"].iter().zip(&data).zip(&fits)
        {
            let of = |single: bool| {
                let chosen = data.rows.iter().zip(&found.fit.residuals);
                rms(chosen.filter(|(row, _)| (row.sub_impacts <= 1) == single).map(|(_, residual)| *residual))
            };
            let numbers = [found.fit.report.rms, of(true), of(false), irregularity(data)].map(|v| significant(v, 2));
            let parameters: Vec<String> = found.fit.parameters.iter().map(|p| significant(*p, 2)).collect();
            let names = [data.beam.title.clone(), (*name).to_owned()];
            lines.push(names.into_iter().chain(numbers).chain([parameters.join(", ")]).collect());
        }
        let [_, slender, thick] = fits.as_slice() else { continue };
        other.push(compared(&data[1], slender, &data[2], thick)?);
    }
    study.tabled("law", &["beam", "table", "rms", "one contact", "several", "irregularity", "μ₀, α₀, α₁"], &lines)?;
    study.text(
        "The table has the rms difference of law and table, over all impacts and over those with one and with several \
         contacts.",
    );
    study.tabled(
        "law-compared",
        &["beam", "Z, change", "e of one contact, change", "rms, own parameters", "rms, Euler-Bernoulli's parameters"],
        &other,
    )?;
    study.text(
        "Timoshenko's theory is compared with Euler-Bernoulli's. The columns have the mean change of Z = m Σ φₖ², \
         which represents the mobility of a location in the law; the mean change of the restitution in the table; and \
         the error of the law on Timoshenko's table, with parameters fitted to it and with those fitted to \
         Euler-Bernoulli's.",
    );
    Ok(())
}

/// Change of the law and of the tables from one theory to the other.
fn compared(
    slender: &Dataset,
    of_slender: &BeamFit,
    thick: &Dataset,
    of_thick: &BeamFit,
) -> Result<Vec<String>, Failure> {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let impacts = of_slender.observations.impacts.iter().zip(&of_thick.observations.impacts);
    let z: Vec<f64> = impacts.filter(|(a, _)| a.z > 1e-9).map(|(a, b)| b.z / a.z - 1.0).collect();
    let both = slender.rows.iter().zip(&thick.rows).filter(|(a, b)| a.sub_impacts <= 1 && b.sub_impacts <= 1);
    let e: Vec<f64> = both.map(|(a, b)| b.e() - a.e()).collect();
    let law = net::law(&of_slender.fit.parameters);
    let mut residuals = Vec::new();
    for (impact, row) in of_thick.observations.impacts.iter().zip(&thick.rows) {
        residuals.push(law.rebound(impact)?.restitution - row.e());
    }
    let percent = format!("{} %", significant(100.0 * mean(&z), 2));
    let numbers = [mean(&e), of_thick.fit.report.rms, rms(residuals.into_iter())].map(|v| significant(v, 2));
    Ok([vec![thick.beam.title.clone(), percent], numbers.to_vec()].concat())
}
