//! Periodic motions of scenes of bodies under harmonic loads, and their branches over a field of the scene.

#[cfg(feature = "files")]
mod picture;
mod summary;
mod text;

use invalid_input::InvalidInput;
use serde_json::Value;
use vibroimpact_sim::assembly::{
    self, BranchSettings, Orbit, OrbitOutcome, OrbitSettings, Reason, SideMotion, find_orbit_until, follow_branch,
};

use crate::assembly::{AssemblyScene, Posed};
use crate::scene::FieldPath;

#[cfg(feature = "files")]
pub use picture::picture;
use summary::INTERRUPTED;
pub use summary::{BranchOrbit, BranchSummary, Found, OrbitSummary, Over, PointMotion, SpecialPoint};
pub use text::text;

impl AssemblyScene {
    /// Finds the periodic motion to which the scene's start leads, or one near it.
    ///
    /// # Errors
    /// As [`AssemblyScene::pose`]; a scene without a harmonic load.
    pub fn orbit(&self, settings: &OrbitSettings) -> Result<Found, InvalidInput> {
        self.orbit_until(settings, &|| false)
    }

    /// As [`AssemblyScene::orbit`]; `stop` is called from time to time, and ends the search with its best result so far.
    ///
    /// # Errors
    /// As [`AssemblyScene::orbit`].
    pub fn orbit_until(&self, settings: &OrbitSettings, stop: &dyn Fn() -> bool) -> Result<Found, InvalidInput> {
        let posed = self.pose()?;
        let settings = OrbitSettings { tolerance: self.tolerance.unwrap_or(settings.tolerance), ..*settings };
        let found = find_orbit_until(&posed.assembly, &settings, stop).map_err(|fault| posed.in_scene(fault))?;
        Ok(match found {
            OrbitOutcome::Found(orbit) => {
                Found { outcome: "found", orbit: Some(OrbitSummary::new(&posed, &orbit)), nearest_closure: None }
            }
            OrbitOutcome::NotFound { closure } => {
                Found { outcome: "not found", orbit: None, nearest_closure: Some(closure) }
            }
            OrbitOutcome::Interrupted { closure, .. } => {
                Found { outcome: INTERRUPTED, orbit: None, nearest_closure: Some(closure) }
            }
            OrbitOutcome::Stopped(assembly::Outcome::Stopped(Reason::Interrupted)) => {
                Found { outcome: INTERRUPTED, orbit: None, nearest_closure: None }
            }
            _ => Found { outcome: "stopped", orbit: None, nearest_closure: None },
        })
    }

    /// Follows the branch of periodic motions over a field. `tell` is called with each value and returns whether to continue.
    ///
    /// # Errors
    /// As [`AssemblyScene::orbit`]; a field that the scene does not have, or that is not a number.
    pub fn orbit_branch(
        &self,
        over: &Over,
        settings: &OrbitSettings,
        mut tell: impl FnMut(f64) -> bool,
    ) -> Result<BranchSummary, InvalidInput> {
        let posed = self.pose()?;
        let tree: Value = serde_json::from_str(&self.to_json()).unwrap_or_default();
        let allowed = "the path of a number in the scene, such as loads[0].frequency_hz";
        let fault = |why: String| InvalidInput::new("--over", crate::scene::json::quote(&over.field.into()), why);
        let path = FieldPath::parse(over.field).ok_or_else(|| fault(allowed.to_owned()))?;
        let present = path.get(&tree).and_then(Value::as_f64);
        let from = over.from.or(present).ok_or_else(|| fault(format!("{allowed}; --from states a first value")))?;
        let build = |value: f64| -> Result<assembly::Assembly<contact_models::Law>, InvalidInput> {
            let mut tree = tree.clone();
            path.set(&mut tree, value.into()).map_err(&fault)?;
            Ok(AssemblyScene::from_value(&tree)?.pose()?.assembly)
        };
        let orbit = OrbitSettings { tolerance: self.tolerance.unwrap_or(settings.tolerance), ..*settings };
        let branch = BranchSettings {
            orbit,
            step: over.step,
            longest_step: over.step.max(0.05),
            ..BranchSettings::over(from, over.to)
        };
        let found = follow_branch(build, &branch, |point| tell(point.parameter))?;
        let orbits = found.points.iter();
        let special = found.special.iter();
        Ok(BranchSummary {
            field: over.field.to_owned(),
            complete: found.complete,
            orbits: orbits
                .map(|point| BranchOrbit { value: point.parameter, orbit: OrbitSummary::new(&posed, &point.orbit) })
                .collect(),
            special_points: special
                .map(|point| SpecialPoint {
                    kind: point.kind.as_str(),
                    value: point.parameter,
                    uncertainty: point.uncertainty,
                    before_orbit: point.before_orbit,
                })
                .collect(),
        })
    }
}

impl OrbitSummary {
    fn new(posed: &Posed, orbit: &Orbit) -> OrbitSummary {
        let point = |c: usize, side: usize, motion: &SideMotion| PointMotion {
            contact: posed.contacts[c].clone(),
            side,
            intervals_per_period: orbit.intervals_per_period[c],
            displacement_first_harmonic_m: motion.displacement_first_harmonic_m,
            displacement_max_m: motion.displacement_max_m,
            displacement_min_m: motion.displacement_min_m,
        };
        let sides = orbit.sides.iter().enumerate();
        OrbitSummary {
            period_s: orbit.period_s,
            forcing_periods: orbit.forcing_periods,
            phase_s: orbit.phase_s,
            closure: orbit.closure,
            floquet_multipliers: orbit.floquet_multipliers.clone(),
            stable: orbit.stable,
            intervals_per_period: orbit.intervals_per_period.iter().sum(),
            points: sides.flat_map(|(c, sides)| [point(c, 0, &sides[0]), point(c, 1, &sides[1])]).collect(),
        }
    }
}

impl BranchSummary {
    /// The orbits as a table, one per row, with the largest multiplier and the motion of every side.
    ///
    /// # Errors
    /// Errors of the writer, which numbers cannot cause.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut table = csv::Writer::from_writer(Vec::new());
        let points = self.orbits.first().map_or(&[][..], |first| &first.orbit.points);
        let mut header: Vec<String> = [&self.field, "period_s", "stable", "intervals_per_period", "largest_multiplier"]
            .map(str::to_owned)
            .to_vec();
        for point in points {
            for quantity in ["displacement_first_harmonic_m", "displacement_max_m", "displacement_min_m"] {
                header.push(format!("{}.{}.{quantity}", point.contact, point.side));
            }
        }
        table.write_record(&header)?;
        for BranchOrbit { value, orbit } in &self.orbits {
            let largest = orbit.floquet_multipliers.first().map_or(0.0, |m| m[0].hypot(m[1]));
            let mut row = vec![
                value.to_string(),
                orbit.period_s.to_string(),
                orbit.stable.to_string(),
                orbit.intervals_per_period.to_string(),
                largest.to_string(),
            ];
            for point in &orbit.points {
                let motion = [point.displacement_first_harmonic_m, point.displacement_max_m, point.displacement_min_m];
                row.extend(motion.map(|value| value.to_string()));
            }
            table.write_record(&row)?;
        }
        table.into_inner().map_err(|fault| fault.into_error().into())
    }
}
