//! The identification itself.

use fitting::{Information, Profile, Start};

use super::data::Data;
use super::derivative::Prediction;
use super::design::{Measured, design};
use super::determined::{combinations, undetermined};
use super::forward::Model;
use super::free::Free;
use super::freedom::quantiles;
use super::gauge::FORCE;
use super::judge::lack_of_fit;
use super::quantity::Quantity;
use super::summary::{Identification, Identified, Noise, Predicted, ProfileCurve, RecordFit, StartFound, Undetermined};
use super::work::{FURTHEST, Work};
use crate::scene::json::number;
use crate::scene::{InvalidInput, Scene};

/// Most starting points of the search.
pub const MOST_STARTS: usize = 1000;
/// Most free fields.
const MOST_FREE: usize = 12;
/// The two intervals count as different if their ends differ by more than this share of the half-width.
const BENT: f64 = 0.1;

/// Options of the identification.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Probability with which each interval is to hold its parameter.
    pub level: f64,
    /// Number of starting points of the search: the scene's values, then the best of 64 times as many points as further
    /// starts are wanted, within the intervals of the search, quasi-random ones and others around the best of these.
    pub starts: usize,
    /// Candidate experiments; see [`Data::read_candidates`].
    pub candidates: Option<Data>,
}

impl Default for Request {
    /// 95 % and four starts, without candidates.
    fn default() -> Request {
        Request { level: 0.95, starts: 4, candidates: None }
    }
}

/// Finds the free fields of a scene from measurements.
///
/// # Errors
/// A field that does not exist or is not a number, too few measurements, or a row whose impact cannot be resolved or does not have
/// a measured quantity.
///
/// ```
/// use vibroimpact::Scene;
/// use vibroimpact::identify::{Data, Free, Request, identify};
///
/// let scene = Scene::from_json(r#"{
///     "structure": { "kind": "modal", "omega_rad_s": [300, 1900], "shape_at_location": [1.1, -0.7] },
///     "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
///     "contact": { "law": "hertz", "stiffness_n_m1_5": 2e9 }
/// }"#)?;
/// // a contact of 0.31 ms and one of 0.27 ms
/// let table = b"striker.speed_m_s,first_contact_s,first_contact_s_sd\n1,3.1e-4,1e-6\n2,2.7e-4,1e-6\n";
/// let data = Data::parse(table, &|_| unreachable!("the table names no file"))?;
/// let found = identify(&scene, &data, &[Free::parse("contact.stiffness_n_m1_5")?], &Request::default())?;
/// let [low, high] = found.parameters[0].covariance_interval.unwrap();
/// assert!(low < found.parameters[0].value && found.parameters[0].value < high && high / low < 1.1);
/// # Ok::<(), vibroimpact::SceneError>(())
/// ```
pub fn identify(scene: &Scene, data: &Data, free: &[Free], request: &Request) -> Result<Identification, InvalidInput> {
    require(data, free, request)?;
    let tree = scene.tree();
    let coordinates = free.iter().map(|free| free.parameter(&tree)).collect::<Result<Vec<_>, _>>()?;
    let start: Vec<f64> = coordinates.iter().map(|parameter| parameter.start).collect();
    let model = Model::new(&tree, data, free, &start)?;
    if let Some(candidates) = &request.candidates {
        model.require_candidates(candidates, &start)?;
    }
    let mut work = Work::new(&model, coordinates)?;
    let (starts, converged) = work.search(request.starts)?;
    let z = quantiles(&work, request.level)?;
    let profiles = work.profiles(&z)?;
    work.conclude(request, starts, converged, &z, profiles)
}

fn require(data: &Data, free: &[Free], request: &Request) -> Result<(), InvalidInput> {
    let fault = |field: &str, value: String, allowed: &str| Err(InvalidInput::new(field, value, allowed));
    if !(1..=MOST_FREE).contains(&free.len()) {
        return fault("--free", format!("{} fields", free.len()), "a list of 1 to 12 fields");
    }
    for (i, one) in free.iter().enumerate() {
        if free[..i].iter().any(|before| before.field == one.field) {
            return fault("--free", one.field.clone(), "stated only once");
        }
        if data.fields.iter().any(|field| field.to_string() == one.field) {
            return fault("--free", one.field.clone(), "a field that the table does not state in each row");
        }
        if one.is_of_gauge() && data.rows.iter().all(|row| row.force.is_none()) {
            return fault("--free", one.field.clone(), "left out, because the table names no force_file");
        }
    }
    if !(0.5..=0.999).contains(&request.level) {
        return fault("--level", number(request.level), "a probability from 0.5 to 0.999");
    }
    if !(1..=MOST_STARTS).contains(&request.starts) {
        return fault("--starts", request.starts.to_string(), "a number of starting points from 1 to 1000");
    }
    let values: usize = data.rows.iter().map(|row| row.measured.len()).sum();
    let records = || data.rows.iter().filter_map(|row| row.force.as_ref());
    let samples: usize = records().map(|(record, _)| record.time_s.len()).sum();
    let needed = free.len() + records().count() + usize::from(!data.stated);
    if values + samples < needed {
        let allowed = format!(
            "at least {needed}, which is one for each free field and for the offset of each force history, and one more \
             if no standard deviations are stated"
        );
        return fault("number of measured values", (values + samples).to_string(), &allowed);
    }
    Ok(())
}

impl Work<'_> {
    fn conclude(
        &self,
        request: &Request,
        starts: Vec<Start>,
        converged: bool,
        z: &[f64],
        profiles: Vec<Profile>,
    ) -> Result<Identification, InvalidInput> {
        let n = self.coordinates.len();
        let data = self.model.data;
        let (rows, information) = self.information()?;
        let sds = information.standard_deviations();
        let covariance = information.covariance();
        let fields: Vec<String> = self.coordinates.iter().map(|parameter| parameter.name.clone()).collect();
        let mut residuals = vec![0.0; self.measured.len()];
        self.residuals(&self.parameters, &mut residuals);
        let followed: Vec<[Option<f64>; 2]> = profiles.iter().map(|profile| [profile.low, profile.high]).collect();
        let open = undetermined(&information, &self.coordinates, &self.parameters, &followed);
        let takes_part = |j: &usize| open.iter().any(|combination| combination.direction.contains_key(&fields[*j]));
        // along such a combination of several fields nothing but the limit of the search makes the sum of squares rise
        let endless = |j: usize| {
            let further = |sd: Option<f64>| sd.is_none_or(|sd| sd > FURTHEST);
            let several = |one: &Undetermined| one.direction.len() > 1 && one.direction.contains_key(&fields[j]);
            open.iter().any(|one| several(one) && further(one.standard_deviation))
        };
        let members: Vec<usize> = (0..n).filter(takes_part).collect();
        let identified = |j: usize| {
            let (parameter, value) = (&self.coordinates[j], self.parameters[j]);
            let (u, half) = (parameter.inward(value), z[j] * sds[j]);
            let ends = match followed[j] {
                // another parameter has met the limit of the search there
                [Some(_), None] | [None, Some(_)] if endless(j) => [None; 2],
                ends => ends,
            };
            let determined = match ends.iter().flatten().count() {
                0 => false,
                1 => !takes_part(&j),
                _ => true,
            };
            let wald = [parameter.outward(u - half), parameter.outward(u + half)];
            let wald = Some(wald).filter(|_| determined && half.is_finite());
            let apart = |end: Option<f64>, sign: f64| {
                end.is_none_or(|end| (parameter.inward(end) - u - sign * half).abs() > BENT * half)
            };
            Identified {
                field: fields[j].clone(),
                start: parameter.start,
                value,
                determined,
                covariance_interval: wald,
                profile_interval: ends,
                bent: wald.is_none() || apart(ends[0], -1.0) || apart(ends[1], 1.0),
            }
        };
        let correlation = covariance.as_ref().map(|c| {
            let entry = |i: usize, j: usize| c[i * n + j] / (c[i * n + i] * c[j * n + j]).sqrt();
            (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
        });
        let noise = self.noise(&residuals);
        let (predictions, records) = self.beside(&rows, &information);
        let candidates = request.candidates.as_ref().map_or_else(Vec::new, |candidates| {
            let of_quantity = |noise: &Noise| Some((Quantity::named(&noise.quantity)?, noise.standard_deviation));
            // a force history would be sampled as the first of those that were measured
            let of_force = |record: &RecordFit| {
                let sd = noise.iter().find(|noise| noise.quantity == FORCE)?.standard_deviation;
                Some((record.samples[0].iter().map(|t| t - record.offset_s).collect(), sd))
            };
            let measured = Measured {
                quantities: noise.iter().filter_map(of_quantity).collect(),
                force: records.first().and_then(of_force),
            };
            design(self.model, candidates, &self.coordinates, &self.parameters, &information, &measured)
        });
        let known = self.known.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let grazes = known.iter().flat_map(|known| &known.rows).zip(&data.rows);
        let grazing = grazes.filter(|(found, _)| found.as_ref().is_none_or(|found| found.grazes));
        Ok(Identification {
            parameters: (0..n).map(identified).collect(),
            level: request.level,
            correlation,
            combinations: combinations(&information, &self.coordinates, &self.parameters, &members, z),
            undetermined: open,
            count: self.measured.len(),
            degrees_of_freedom: self.freedom,
            sum_of_squares: self.sum_of_squares,
            converged: converged && profiles.iter().all(|profile| profile.better.is_none()),
            noise,
            lack_of_fit: lack_of_fit(data, &residuals, self.freedom),
            modes: self.model.modes(),
            left_out_modes_sd: self.model.left_out_sd(),
            grazing_lines: grazing.map(|(_, row)| row.line).collect(),
            starts: starts
                .into_iter()
                .map(|Start { from, parameters, sum_of_squares, .. }| StartFound {
                    from,
                    parameters,
                    robust_sum: Some(sum_of_squares).filter(|sum| sum.is_finite()),
                })
                .collect(),
            predictions,
            records,
            candidates,
            profiles: profiles
                .into_iter()
                .zip(fields.iter().zip(z))
                .map(|(profile, (field, z))| {
                    let finite = profile.points.iter().filter(|(_, sum)| sum.is_finite());
                    let (values, rise) = finite.map(|(value, sum)| (*value, sum - self.sum_of_squares)).unzip();
                    ProfileCurve { field: field.clone(), values, rise, limit: z * z }
                })
                .collect(),
        })
    }

    fn noise(&self, residuals: &[f64]) -> Vec<Noise> {
        let of_group = |(place, name): (usize, &&'static str)| {
            let members: Vec<usize> = (0..self.measured.len()).filter(|k| self.measured[*k].1 == place).collect();
            let mean_square = |of: &dyn Fn(usize) -> f64| {
                (members.iter().map(|&k| of(k).powi(2)).sum::<f64>() / members.len() as f64).sqrt()
            };
            Noise {
                quantity: (*name).to_owned(),
                count: members.len(),
                standard_deviation: mean_square(&|k| self.sd[k]),
                stated: self.model.data.stated,
                rms: mean_square(&|k| self.sd[k] * residuals[k]),
            }
        };
        self.groups.iter().enumerate().map(of_group).collect()
    }

    /// Measurements and predictions.
    fn beside(&self, rows: &[f64], information: &Information) -> (Vec<Predicted>, Vec<RecordFit>) {
        let n = self.coordinates.len();
        let (mut predictions, mut records) = (Vec::new(), Vec::new());
        let mut place = 0;
        for (row, found) in self.model.data.rows.iter().zip(self.predictions(&self.parameters)) {
            let found = found.unwrap_or(Prediction { values: Vec::new(), offset_s: None, sub_impacts: 0 });
            let value = |k: usize| found.values.get(k).copied().unwrap_or(f64::NAN);
            for (k, (quantity, measured, _)) in row.measured.iter().enumerate() {
                let sd = self.sd[place + k];
                let spread = sd * information.of_prediction(&rows[(place + k) * n..(place + k + 1) * n]);
                predictions.push(Predicted {
                    line: row.line,
                    quantity: quantity.name(),
                    measured: *measured,
                    predicted: value(k),
                    measured_sd: sd,
                    predicted_sd: Some(spread).filter(|spread| spread.is_finite()),
                });
            }
            place += row.measured.len();
            if let Some((record, _)) = &row.force {
                let shown = (0..record.time_s.len()).map(|k| value(row.measured.len() + k)).collect();
                records.push(RecordFit {
                    line: row.line,
                    file: record.file.clone(),
                    offset_s: found.offset_s.unwrap_or(f64::NAN),
                    samples: [record.time_s.clone(), record.force_n.clone(), shown],
                });
                place += record.time_s.len();
            }
        }
        (predictions, records)
    }
}
