//! Periodic motions of scenes of bodies under harmonic loads, and their branches over a field of the scene.

#[cfg(feature = "files")]
mod picture;
mod summary;
mod text;

use contact_models::Law;
use invalid_input::InvalidInput;
use serde_json::Value;
use std::collections::BTreeSet;
use vibroimpact_sim::assembly::{
    Assembly, Branch, BranchSettings, Orbit, OrbitOutcome, OrbitSettings, Outcome, Reason, SideMotion,
    find_orbit_until, follow_beginning, follow_branch,
};

use crate::assembly::{AssemblyScene, Posed};
use crate::scene::FieldPath;

#[cfg(feature = "files")]
pub use picture::picture;
use summary::INTERRUPTED;
pub use summary::{
    BranchOrbit, BranchPart, BranchSummary, Found, OrbitSummary, Over, PointMotion, Recurrence, SideBranch,
    SpecialPoint,
};
pub use text::text;

impl AssemblyScene {
    /// Finds the periodic motion to which the scene's start leads, or one near it.
    ///
    /// # Errors
    /// As [`AssemblyScene::pose`]; a scene without a harmonic load, or with loads that have no common period.
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
        let found = find_orbit_until(&posed.assembly, &settings, stop).map_err(|fault| in_scene(&posed, fault))?;
        let none = Found {
            outcome: INTERRUPTED,
            reason: None,
            orbit: None,
            nearest_closure: None,
            recurrence: None,
            remembering_contact: None,
        };
        Ok(match found {
            OrbitOutcome::Found(orbit) => {
                Found { outcome: "found", orbit: Some(OrbitSummary::new(&posed, &orbit)), ..none }
            }
            OrbitOutcome::NotFound { closure, recurrence } => {
                let recurrence = recurrence.as_ref().map(Recurrence::new);
                Found { outcome: "not found", nearest_closure: Some(closure), recurrence, ..none }
            }
            OrbitOutcome::Remembers { contact } => {
                let remembering_contact = Some(posed.contacts[contact].clone());
                Found { outcome: "not found", remembering_contact, ..none }
            }
            OrbitOutcome::Interrupted { closure, .. } => Found { nearest_closure: Some(closure), ..none },
            OrbitOutcome::Stopped(Outcome::Stopped(Reason::Interrupted)) => none,
            OrbitOutcome::Stopped(Outcome::Stopped(reason)) => {
                Found { outcome: "stopped", reason: Some(reason.as_str()), ..none }
            }
            _ => Found { outcome: "stopped", ..none },
        })
    }

    /// Follows the branch of periodic motions over a field, and the branches that begin at its period doublings and pitchforks as often
    /// as requested. `stop` is called from time to time, and ends the search with the orbits so far.
    ///
    /// # Errors
    /// As [`AssemblyScene::orbit`]; a field that the scene does not have, that is not a number, or on which the periodic motion does
    /// not depend.
    pub fn orbit_branch(
        &self,
        over: &Over,
        settings: &OrbitSettings,
        stop: &dyn Fn() -> bool,
    ) -> Result<BranchSummary, InvalidInput> {
        let posed = self.pose()?;
        let tree: Value = serde_json::from_str(&self.to_json()).unwrap_or_default();
        let allowed = "the path of a number in the scene, such as loads[0].frequency_hz";
        let fault = |why: String| InvalidInput::new("--over", crate::scene::json::quote(&over.field.into()), why);
        let path = FieldPath::parse(over.field).ok_or_else(|| fault(allowed.to_owned()))?;
        let present = path.get(&tree).and_then(Value::as_f64);
        let from = over
            .from
            .or(present)
            .ok_or_else(|| fault(format!("{allowed}, or have its first value stated by --from")))?;
        let pose = |value: f64| -> Result<Assembly<Law>, InvalidInput> {
            let mut tree = tree.clone();
            path.set(&mut tree, value.into()).map_err(|why| fault(format!("{allowed}, but {why}")))?;
            Ok(AssemblyScene::from_value(&tree)?.pose()?.assembly)
        };
        let first = pose(from)?;
        if from != over.to && pose(over.to).is_ok_and(|last| without_start(first.clone()) == without_start(last)) {
            return Err(fault(format!(
                "{allowed}, on which the periodic motion depends; this field has an influence at most on the start, the end or \
                 the accuracy of a run"
            )));
        }
        let orbit = OrbitSettings { tolerance: self.tolerance.unwrap_or(settings.tolerance), ..*settings };
        let branch = BranchSettings {
            orbit,
            step: over.step,
            longest_step: over.step.max(0.05),
            ..BranchSettings::over(from, over.to)
        };
        let build = |value: f64| pose(value).map_err(Fault::Scene);
        let in_scene = |fault| match fault {
            Fault::Scene(fault) => fault,
            Fault::Assembly(fault) => in_scene(&posed, fault),
        };
        let main = follow_branch(build, &branch, stop).map_err(in_scene)?;
        let mut side = Vec::new();
        // those that begin on the branches of the turn before
        let mut parents = vec![(0, main.clone())];
        for _ in 0..over.branches {
            let mut found = Vec::new();
            for (number, parent) in &parents {
                let mut returned_to = BTreeSet::new();
                for (special, point) in parent.special.iter().enumerate() {
                    if !point.kind.begins_a_branch() || returned_to.contains(&special) || stop() {
                        continue;
                    }
                    let begun = follow_beginning(build, &branch, parent, special, stop).map_err(in_scene)?;
                    returned_to.extend(begun.returns_to);
                    side.push(SideBranch {
                        parent: *number,
                        begins_with: point.kind.as_str(),
                        begins_at: point.parameter,
                        ends_at: begun.returns_to.map(|special| parent.special[special].parameter),
                        branch: BranchPart::new(&posed, &begun),
                    });
                    found.push((side.len(), begun));
                }
            }
            parents = found;
        }
        Ok(BranchSummary { field: over.field.to_owned(), main: BranchPart::new(&posed, &main), branches: side })
    }
}

/// An error under the names of the scene, or under those of the assembly.
enum Fault {
    Scene(InvalidInput),
    Assembly(InvalidInput),
}

impl From<InvalidInput> for Fault {
    fn from(fault: InvalidInput) -> Fault {
        Fault::Assembly(fault)
    }
}

/// An error of the search. Its runs end after periods of the loads, not at the scene's `end_s`.
fn in_scene(posed: &Posed, fault: InvalidInput) -> InvalidInput {
    if fault.field != "end_s" {
        return posed.in_scene(fault);
    }
    let found = fault.value.map_or_else(String::new, |found| found.to_string());
    let allowed =
        "loads of such a period that as many as are followed, of the motion and before the search, last at most 1e12 s";
    InvalidInput::new("loads", format!("periods of together {found} s"), allowed)
}

/// The part of an assembly that determines the map over a period.
fn without_start(mut assembly: Assembly<Law>) -> Assembly<Law> {
    for body in &mut assembly.bodies {
        (body.amplitude, body.rate) = (Vec::new(), Vec::new());
    }
    assembly
}

impl BranchPart {
    fn new(posed: &Posed, branch: &Branch) -> BranchPart {
        let orbits = branch.points.iter();
        let special = branch.special.iter();
        BranchPart {
            complete: branch.complete,
            interrupted: branch.interrupted,
            remembering_contact: branch.remembers.map(|contact| posed.contacts[contact].clone()),
            orbits: orbits
                .map(|point| BranchOrbit { value: point.parameter, orbit: OrbitSummary::new(posed, &point.orbit) })
                .collect(),
            special_points: special
                .map(|point| SpecialPoint {
                    kind: point.kind.as_str(),
                    value: point.parameter,
                    uncertainty: point.uncertainty,
                    before_orbit: point.before_orbit,
                    orbit: OrbitSummary::new(posed, &point.orbit),
                })
                .collect(),
        }
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
            displacement_section_m: orbit.section_m.iter().map(|moment| moment[c][side]).collect(),
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
    /// The branch, number 0, and those that begin at others.
    pub fn all(&self) -> impl Iterator<Item = &BranchPart> {
        std::iter::once(&self.main).chain(self.branches.iter().map(|side| &side.branch))
    }

    /// The orbits of all branches as a table, one per row, with the largest multiplier and the motion of every side.
    ///
    /// # Errors
    /// Errors of the writer, which numbers cannot cause.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut table = csv::Writer::from_writer(Vec::new());
        let points = self.main.orbits.first().map_or(&[][..], |first| &first.orbit.points);
        let mut header: Vec<String> = [
            &self.field,
            "branch",
            "forcing_periods",
            "period_s",
            "stable",
            "intervals_per_period",
            "largest_multiplier",
        ]
        .map(str::to_owned)
        .to_vec();
        for point in points {
            for quantity in ["displacement_first_harmonic_m", "displacement_max_m", "displacement_min_m"] {
                header.push(format!("{}.{}.{quantity}", point.contact, point.side));
            }
        }
        table.write_record(&header)?;
        for (number, branch) in self.all().enumerate() {
            for BranchOrbit { value, orbit } in &branch.orbits {
                let mut row = vec![
                    value.to_string(),
                    number.to_string(),
                    orbit.forcing_periods.to_string(),
                    orbit.period_s.to_string(),
                    orbit.stable.to_string(),
                    orbit.intervals_per_period.to_string(),
                    orbit.largest_multiplier().to_string(),
                ];
                for point in &orbit.points {
                    let motion =
                        [point.displacement_first_harmonic_m, point.displacement_max_m, point.displacement_min_m];
                    row.extend(motion.map(|value| value.to_string()));
                }
                table.write_record(&row)?;
            }
        }
        table.into_inner().map_err(|fault| fault.into_error().into())
    }
}
