//! From the rows of a sweep to a distribution for each point of its grid, and to their table.

use super::design::{Draws, Uncertain};
use super::estimate::{Estimate, RestitutionDistribution};
use crate::scene::json::number;
use crate::sweep::definition::Sweep;
use crate::sweep::row::{Row, cell, line};

/// Takes rows in order.
pub(in crate::sweep) struct Collector<'a> {
    uncertain: &'a Uncertain,
    layout: Draws,
    names: Option<Vec<String>>,
    /// Restitutions of the grid point whose draws come now.
    draws: Vec<f64>,
    found: Vec<Option<RestitutionDistribution>>,
}

impl<'a> Collector<'a> {
    pub fn new(uncertain: &'a Uncertain) -> Collector<'a> {
        let names = || uncertain.fields.iter().map(|(field, _)| field.to_string()).collect();
        let names = uncertain.sampling.indices.then(names);
        Collector { uncertain, layout: uncertain.draws(), names, draws: Vec::new(), found: Vec::new() }
    }

    pub fn add(&mut self, row: &Row) {
        self.draws.push(row.number("restitution").unwrap_or(f64::NAN));
        if self.draws.len() as u64 == self.layout.count() {
            self.close();
        }
    }

    fn close(&mut self) {
        self.found.push(RestitutionDistribution::new(&self.draws, self.layout, self.names.as_deref()));
        self.draws.clear();
    }

    /// The distribution of every grid point; `None` of one without any restitution.
    pub fn finish(mut self) -> Vec<Option<RestitutionDistribution>> {
        // fewer draws than there could be, because they were enough
        if !self.draws.is_empty() {
            self.close();
        }
        self.found
    }

    /// Whether the sampling error is as small as was wanted.
    pub fn enough(self) -> bool {
        let wanted = self.uncertain.sampling.sampling_error.unwrap_or_default();
        self.finish().iter().flatten().all(|found| found.largest_error() <= wanted)
    }
}

/// A table with a row for each grid point: the varied fields, and every figure with its standard error.
pub(in crate::sweep) fn table(sweep: &Sweep, found: &[Option<RestitutionDistribution>]) -> Vec<u8> {
    let axes = sweep.axes.iter().map(|axis| axis.field.to_string());
    let some = found.iter().flatten().next();
    let names = some.map_or_else(Vec::new, |found| figures(found).into_iter().map(|(name, _)| name).collect());
    let with_error = |name: &String| [name.clone(), format!("{name}_standard_error")];
    let counts = ["draws", "with_restitution"].map(str::to_owned);
    let mut rows = line(axes.chain(counts).chain(names.iter().flat_map(with_error)));
    for (place, found) in found.iter().enumerate() {
        let values = sweep.values(place as u64 * sweep.draws());
        let axes = values[..sweep.axes.len()].iter().map(cell);
        let cells = match found {
            Some(found) => {
                let counts = [found.draws, found.with_restitution].map(|count| count.to_string());
                let known = |error: Option<f64>| error.map_or_else(String::new, number);
                let figures =
                    figures(found).into_iter().flat_map(|(_, it)| [number(it.value), known(it.standard_error)]);
                counts.into_iter().chain(figures).collect()
            }
            None => {
                let counts = [sweep.draws().to_string(), "0".to_owned()];
                counts.into_iter().chain(vec![String::new(); 2 * names.len()]).collect::<Vec<_>>()
            }
        };
        rows.extend(line(axes.chain(cells)));
    }
    rows
}

/// All figures of a distribution by their column.
fn figures(found: &RestitutionDistribution) -> Vec<(String, Estimate)> {
    let RestitutionDistribution { mean, standard_deviation, width_90, quantiles, indices, .. } = found;
    let moments = [("mean", mean), ("standard_deviation", standard_deviation), ("width_90", width_90)];
    let moments = moments.map(|(name, figure)| (name.to_owned(), *figure));
    let quantiles = quantiles.iter().map(|quantile| {
        let figure = Estimate { value: quantile.value, standard_error: quantile.standard_error };
        (format!("quantile_{}", quantile.share), figure)
    });
    let indices = indices.iter().flatten().flat_map(|(field, indices)| {
        [(format!("first_index_{field}"), indices.first), (format!("total_index_{field}"), indices.total)]
    });
    moments.into_iter().chain(quantiles).chain(indices).collect()
}
