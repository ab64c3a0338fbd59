//! Distributions at each point of the grid from the rows of a sweep, and their table.

use super::design::{Draws, Output, Uncertain};
use super::estimate::OutputDistribution;
use super::figure::Estimate;
use crate::scene::json::number;
use crate::sweep::definition::Sweep;
use crate::sweep::row::{Row, cell, lines};

/// The distribution of every output at a point of the grid; `None` for an output that no draw has.
pub(in crate::sweep) type Distributions = Vec<Option<OutputDistribution>>;

/// Receives rows in order.
pub(in crate::sweep) struct Collector<'a> {
    uncertain: &'a Uncertain,
    layout: Draws,
    fields: Option<Vec<String>>,
    /// Positions of the outputs in a row.
    places: Vec<Option<usize>>,
    /// Values of each output at the present grid point.
    draws: Vec<Vec<f64>>,
    found: Vec<Distributions>,
}

impl<'a> Collector<'a> {
    /// `None` for a sweep without uncertain fields.
    pub fn new(sweep: &'a Sweep) -> Option<Collector<'a>> {
        let uncertain = sweep.uncertain.as_ref()?;
        let names = || uncertain.fields.iter().map(|(field, _)| field.to_string()).collect();
        let fields = uncertain.sampling.indices.then(names);
        let places = uncertain.outputs.iter().map(|output| sweep.results().place(&output.name)).collect();
        let draws = vec![Vec::new(); uncertain.outputs.len()];
        Some(Collector { uncertain, layout: uncertain.draws(), fields, places, draws, found: Vec::new() })
    }

    pub fn add(&mut self, row: &Row) {
        // the outputs of a run that was stopped are not those at its end
        let complete = row.text("outcome") != "stopped";
        for (draws, place) in self.draws.iter_mut().zip(&self.places) {
            let value = place.filter(|_| complete).and_then(|place| row.number_at(place));
            draws.push(value.unwrap_or(f64::NAN));
        }
        if self.draws.iter().any(|draws| draws.len() as u64 == self.layout.count()) {
            self.close();
        }
    }

    fn close(&mut self) {
        let of = |(draws, output): (&mut Vec<f64>, &Output)| {
            let found = OutputDistribution::new(draws, self.layout, self.fields.as_deref(), output.sampling_error);
            draws.clear();
            found
        };
        self.found.push(self.draws.iter_mut().zip(&self.uncertain.outputs).map(of).collect());
    }

    /// The distributions at every point of the grid.
    pub fn finish(mut self) -> Vec<Distributions> {
        // fewer draws than the maximum, because they were sufficient
        if self.draws.iter().any(|draws| !draws.is_empty()) {
            self.close();
        }
        self.found
    }

    /// Whether all sampling errors are as small as requested.
    pub fn enough(self) -> bool {
        self.finish().iter().flatten().flatten().all(|found| found.reached != Some(false))
    }
}

/// A table with a row for each grid point and output: the varied fields, and every figure with its standard error.
pub(in crate::sweep) fn table(sweep: &Sweep, found: &[Distributions]) -> Vec<u8> {
    let axes = sweep.axes.iter().map(|axis| axis.field.to_string());
    let outputs = || sweep.uncertain.iter().flat_map(|uncertain| &uncertain.outputs);
    // indices exist if the output varies
    let most = found.iter().flatten().flatten().map(figures).max_by_key(Vec::len);
    let names: Vec<String> = most.unwrap_or_default().into_iter().map(|(name, _)| name).collect();
    let with_error = |name: &String| [name.clone(), format!("{name}_standard_error")];
    let counts = ["output", "draws", "with_value"].map(str::to_owned);
    let mut rows: Vec<Vec<String>> = vec![axes.chain(counts).chain(names.iter().flat_map(with_error)).collect()];
    for (place, found) in found.iter().enumerate() {
        let values = sweep.values(place as u64 * sweep.draws());
        for (output, found) in outputs().zip(found) {
            let axes = values[..sweep.axes.len()].iter().map(cell).chain([output.name.clone()]);
            let counts = found.as_ref().map_or([sweep.draws(), 0], |found| [found.draws, found.with_value]);
            let known = |error: Option<f64>| error.map_or_else(String::new, number);
            let told = found.iter().flat_map(figures).flat_map(|(_, it)| [number(it.value), known(it.standard_error)]);
            let empty = std::iter::repeat(String::new());
            let cells = told.chain(empty).take(2 * names.len());
            rows.push(axes.chain(counts.map(|count| count.to_string())).chain(cells).collect());
        }
    }
    lines(rows)
}

/// All figures of a distribution by their column.
fn figures(found: &OutputDistribution) -> Vec<(String, Estimate)> {
    let OutputDistribution { mean, standard_deviation, width_90, quantiles, indices, .. } = found;
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
