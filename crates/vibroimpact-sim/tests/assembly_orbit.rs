//! Periodic motions compared with closed forms.

use contact_models::{Hysteretic, KelvinVoigt, Law, LinearSpring, Thornton};
use std::cell::Cell;
use std::f64::consts::PI;
use vibroimpact_sim::InvalidInput;
use vibroimpact_sim::assembly::{
    Assembly, Body, BodyMode, BranchSettings, Contact, Force, Interval, Load, Observer, Orbit, OrbitOutcome,
    OrbitSettings, Outcome, Point, Reason, Settings, Special, find_orbit, find_orbit_until, follow_beginning,
    follow_branch, run,
};

fn point(shape: f64) -> Point {
    Point::OfBody { body: 0, shape: vec![shape] }
}

/// A damped oscillator of 1 kg beside a stop, under a harmonic load.
fn driven(damping_ratio: f64, gap_m: f64, force_n: f64, omega_rad_s: f64) -> Assembly<Law> {
    let body = Body::at_rest(vec![BodyMode { omega_rad_s: 10.0, damping_ratio }]);
    let law = Law::from(LinearSpring::new(50.0).unwrap());
    let stop = Contact { sides: [Point::Ground, point(1.0)], gap_m, law };
    let force = Force::Harmonic { force_n, omega_rad_s, phase_rad: 0.3 };
    Assembly { bodies: vec![body], contacts: vec![stop], loads: vec![Load { body: 0, shape: vec![1.0], force }] }
}

#[test]
fn without_contact_the_orbit_is_the_steady_motion_and_its_multipliers_are_known() {
    let (zeta, omega) = (0.02f64, 7.0);
    let assembly = driven(zeta, 1.0, 1.0, omega);
    let OrbitOutcome::Found(orbit) = find_orbit(&assembly, &OrbitSettings::default()).unwrap() else { panic!() };
    let period = 2.0 * PI / omega;
    assert!((orbit.period_s - period).abs() < 1e-14);
    assert_eq!(orbit.intervals_per_period, [0]);
    let amplitude = ((100.0f64 - omega * omega).powi(2) + (2.0 * zeta * 10.0 * omega).powi(2)).sqrt().recip();
    let side = orbit.sides[0][1];
    assert!((side.displacement_first_harmonic_m / amplitude - 1.0).abs() < 1e-9, "{side:?}");
    assert!((side.displacement_max_m / amplitude - 1.0).abs() < 1e-5);
    // exp(lambda T), lambda = -zeta omega_0 +- i omega_d.
    let (size, angle) = ((-zeta * 10.0 * period).exp(), 10.0 * (1.0 - zeta * zeta).sqrt() * period);
    for multiplier in &orbit.floquet_multipliers {
        assert!((multiplier[0] - size * angle.cos()).abs() < 1e-12, "{multiplier:?}");
        assert!((multiplier[1].abs() - (size * angle.sin()).abs()).abs() < 1e-12);
    }
    assert!(orbit.stable);
}

#[test]
fn an_orbit_against_a_stop_repeats_itself_and_its_multipliers_have_the_right_product() {
    let (zeta, omega) = (0.05, 9.0);
    let assembly = driven(zeta, 1e-3, 1.0, omega);
    let OrbitOutcome::Found(orbit) = find_orbit(&assembly, &OrbitSettings::default()).unwrap() else { panic!() };
    assert!(orbit.stable && orbit.intervals_per_period == [1] && orbit.iterations <= 5, "{orbit:?}");
    // Liouville: only the damping reduces the volume in the space of states.
    let product = orbit
        .floquet_multipliers
        .iter()
        .fold((1.0, 0.0), |(re, im): (f64, f64), m| (re * m[0] - im * m[1], re * m[1] + im * m[0]));
    let volume = (-2.0 * zeta * 10.0 * orbit.period_s).exp();
    assert!((product.0 - volume).abs() < 1e-10 && product.1.abs() < 1e-12, "{product:?} {volume}");
    // A long transient converges to it.
    let mut settings = Settings::until(400.0 * orbit.period_s + orbit.phase_s);
    settings.tolerance = 1e-11;
    let found = run(&assembly, &settings, &mut ()).unwrap();
    assert!((found.amplitude[0][0] - orbit.state[0]).abs() < 1e-9 * orbit.sides[0][1].displacement_max_m.abs() + 1e-11);
    assert!((found.rate[0][0] - orbit.state[1]).abs() < 1e-8);
}

/// If it is stopped after a number of queries, the search reports this and the best approximation.
#[test]
fn a_stopped_search_returns_its_best_approximation() {
    let assembly = driven(0.05, 1e-3, 1.0, 9.0);
    let settings = OrbitSettings { transient_periods: 3, ..OrbitSettings::default() };
    let mut closures = Vec::new();
    for most in 0.. {
        let asked = Cell::new(0);
        let stop = || {
            asked.set(asked.get() + 1);
            asked.get() > most
        };
        match find_orbit_until(&assembly, &settings, &stop).unwrap() {
            OrbitOutcome::Interrupted { closure, state } => {
                assert_eq!(state.len(), 2);
                closures.push(closure);
            }
            OrbitOutcome::Stopped(Outcome::Stopped(Reason::Interrupted)) => assert!(closures.is_empty()),
            OrbitOutcome::Found(orbit) => {
                assert!(orbit.closure < 1e-9);
                break;
            }
            other => panic!("{other:?}"),
        }
    }
    assert!(closures.len() > 1 && closures.iter().all(|closure| *closure >= 0.0), "{closures:?}");
    assert!(closures.windows(2).all(|pair| pair[1] <= pair[0]), "{closures:?}");
}

/// A ball under gravity on a table that moves by `A sin(omega t)`, in the frame of the table, against a stiff floor with the
/// restitution `e` of a viscous contact.
fn shaken(gamma: f64, e: f64) -> Assembly<Law> {
    let (m, omega, g) = (0.1f64, 100.0 * PI, 9.81);
    let (k, zeta) = (1e9, restitution_damping(e));
    let c = 2.0 * zeta * (k * m).sqrt();
    let law = Law::from(contact_models::KelvinVoigt::new(k, c).unwrap());
    let contact =
        Contact { sides: [Point::OfBody { body: 0, shape: vec![m.sqrt().recip()] }, Point::Ground], gap_m: 0.0, law };
    let field = |force| Load { body: 0, shape: vec![m.sqrt()], force };
    Assembly {
        // Thrown up so that it lands after one period in the phase of the periodic motion.
        bodies: vec![Body::mass(m, 0.0, 0.5 * g * 2.0 * PI / omega)],
        contacts: vec![contact],
        loads: vec![
            field(Force::Constant { force_n: -g }),
            field(Force::Harmonic { force_n: gamma * g, omega_rad_s: omega, phase_rad: phase(gamma, e) }),
        ],
    }
}

/// The phase of the impact: the table's velocity then compensates the loss, cos(phase) = pi (1-e)/(1+e)/gamma.
fn phase(gamma: f64, e: f64) -> f64 {
    (PI * (1.0 - e) / (1.0 + e) / gamma).acos()
}

/// Damping ratio of a linear contact without adhesion that gives this restitution.
fn restitution_damping(e: f64) -> f64 {
    let of = |z: f64| {
        let root = (1.0 - z * z).sqrt();
        (-z / root * (PI - (2.0 * z * root).atan2(1.0 - 2.0 * z * z))).exp()
    };
    bisected(0.0, 0.99, |z| of(z) > e)
}

/// Where a condition that holds below a point, and nowhere above it, ends.
fn bisected(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if holds(middle) { &mut low } else { &mut high }) = middle;
    }
    low
}

#[test]
fn a_ball_on_a_shaken_table_loses_its_stability_at_the_closed_forms_threshold() {
    let e = 0.8;
    // Period one is stable from 0.349 to 1.0708, where it doubles.
    for (gamma, stable) in [(0.6, true), (1.0, true), (1.15, false)] {
        let assembly = shaken(gamma, e);
        let settings = OrbitSettings { transient_periods: 0, ..Default::default() };
        match find_orbit(&assembly, &settings).unwrap() {
            OrbitOutcome::Found(orbit) => {
                assert_eq!(orbit.intervals_per_period, [1], "{gamma} {orbit:?}");
                assert_eq!(orbit.stable, stable, "{gamma}: {:?}", orbit.floquet_multipliers);
                let size = orbit.floquet_multipliers.iter().map(|m| m[0] * m[0] + m[1] * m[1]).product::<f64>().sqrt();
                assert!((size / (e * e) - 1.0).abs() < 0.02, "{gamma} {size}");
            }
            other => panic!("{gamma}: {other:?}"),
        }
    }
}

/// Above the threshold the ball converges to a motion of two periods. A search for three that is not given enough iterations says so.
#[test]
fn a_search_in_vain_tells_after_how_many_periods_the_motion_repeats_itself() {
    let assembly = shaken(1.1, 0.8);
    let settings = OrbitSettings { forcing_periods: 3, max_iterations: 1, search_periods: 400, ..Default::default() };
    let OrbitOutcome::NotFound { closure, recurrence: Some(recurrence) } = find_orbit(&assembly, &settings).unwrap()
    else {
        panic!()
    };
    assert!(closure > 1e-9);
    assert_eq!((recurrence.forcing_periods, recurrence.has_converged), (2, true), "{recurrence:?}");
    assert!(recurrence.separation_per_period < 1.0 && recurrence.distance < 1e-4, "{recurrence:?}");
}

/// Far above it the motion is chaotic, and nearby motions separate at the rate at which the distance of two runs grows.
#[test]
fn nearby_motions_of_a_chaotic_motion_separate() {
    let assembly = shaken(2.5, 0.8);
    let settings = OrbitSettings { forcing_periods: 7, max_iterations: 1, search_periods: 200, ..Default::default() };
    let OrbitOutcome::NotFound { recurrence: Some(recurrence), .. } = find_orbit(&assembly, &settings).unwrap() else {
        panic!()
    };
    assert!(!recurrence.has_converged && recurrence.separation_per_period > 1.1, "{recurrence:?}");
}

#[derive(Default)]
struct Starts(Vec<f64>);

impl Observer for Starts {
    fn interval(&mut self, _: usize, interval: &Interval) {
        self.0.push(interval.start_s);
    }
}

#[test]
fn the_free_oscillation_against_a_stop_has_the_closed_forms_frequency() {
    // SDND122, without its slip: 0.64663104064 Hz.
    let energy = 0.006_501_083_316_26f64;
    let body = Body {
        modes: vec![BodyMode { omega_rad_s: 10f64.sqrt(), damping_ratio: 0.0 }],
        amplitude: vec![0.0],
        rate: vec![(2.0 * energy).sqrt()],
    };
    let law = Law::from(LinearSpring::new(50.0).unwrap());
    let stop = Contact { sides: [Point::Ground, point(1.0)], gap_m: 0.01, law };
    let assembly = Assembly { bodies: vec![body], contacts: vec![stop], loads: vec![] };
    let mut starts = Starts::default();
    let mut settings = Settings::until(40.0);
    settings.tolerance = 1e-12;
    run(&assembly, &settings, &mut starts).unwrap();
    let n = starts.0.len() - 1;
    let frequency = n as f64 / (starts.0[n] - starts.0[0]);
    assert!((frequency - 0.646_631_040_64).abs() < 1e-10, "{frequency}");
}

#[test]
fn the_branch_of_the_shaken_ball_doubles_at_the_closed_forms_threshold() {
    let e = 0.8;
    let mut settings = BranchSettings::over(0.6, 1.3);
    settings.orbit.transient_periods = 0;
    let branch = follow_branch(|gamma| Ok::<_, InvalidInput>(shaken(gamma, e)), &settings, &|| false).unwrap();
    assert!(branch.complete, "{:?}", branch.points.last());
    let doubling: Vec<_> = branch.special.iter().filter(|point| point.kind == Special::PeriodDoubling).collect();
    assert_eq!(doubling.len(), 1, "{:?}", branch.special);
    // The contact is not instantaneous: it takes 20 us of a period of 20 ms.
    assert!((doubling[0].parameter / 1.0708365 - 1.0).abs() < 5e-3, "{doubling:?}");
    assert!(branch.points.iter().all(|p| p.orbit.stable == (p.parameter < doubling[0].parameter)));

    // The branch of two periods begins there, on the side where the motion of one period is unstable.
    let build = |gamma| Ok::<_, InvalidInput>(shaken(gamma, e));
    let doubled = follow_beginning(build, &settings, &branch, 0, &|| false).unwrap();
    assert!(doubled.points.len() > 5, "{doubled:?}");
    let [first, last] = [&doubled.points[1], &doubled.points[doubled.points.len() - 1]];
    assert!(first.orbit.stable && first.parameter > doubling[0].parameter - 1e-6, "{first:?}");
    assert_eq!((first.orbit.forcing_periods, &first.orbit.intervals_per_period), (2, &vec![2]));
    assert!(last.parameter > 1.1, "{last:?}");
    for point in &doubled.points[1..] {
        let [one, other] = [0, 1].map(|period: usize| point.orbit.section_m[period][0][0]);
        let size = point.orbit.sides[0][0].displacement_max_m;
        assert!((one - other).abs() > 1e-5 * size, "{point:?}");
    }
    // Transients lead to its stable orbits.
    let stable = doubled.points.iter().rfind(|point| point.orbit.stable).unwrap();
    let twice = OrbitSettings { forcing_periods: 2, transient_periods: 300, ..OrbitSettings::default() };
    let OrbitOutcome::Found(reached) = find_orbit(&shaken(stable.parameter, e), &twice).unwrap() else { panic!() };
    let highest = |orbit: &vibroimpact_sim::assembly::Orbit| orbit.sides[0][0].displacement_max_m;
    assert!((highest(&reached) / highest(&stable.orbit) - 1.0).abs() < 1e-6, "{reached:?} {stable:?}");
}

/// A mass that rattles between two stiff walls with the restitution `e`, in the frame of the walls, which are shaken with the acceleration
/// `a sin(omega t)`; and the closed form of its symmetric motion, one impact at each wall a period.
struct Rattle {
    e: f64,
    omega: f64,
    /// Half of the way between the walls (m).
    half_m: f64,
}

impl Rattle {
    /// Phase of the impact at one wall, and the speed before it: half a period later the mass has crossed, and meets the other as fast.
    fn symmetric(&self, a: f64) -> (f64, f64) {
        let &Rattle { e, omega, half_m } = self;
        let factor = PI * (1.0 + e) / (1.0 - e);
        let phase = 2.0f64.atan2(factor) - (2.0 * half_m * omega * omega / a / factor.hypot(2.0)).acos();
        (phase, 2.0 * a * phase.cos() / (omega * (1.0 - e)))
    }

    /// `1 + trace + determinant` of the map of phase and speed from one wall to the other, mirrored: negative beyond an eigenvalue of -1.
    /// Over a whole period that eigenvalue is +1, and the motion loses its symmetry.
    fn symmetry_margin(&self, a: f64) -> f64 {
        let &Rattle { e, omega, .. } = self;
        let ((phase, speed), half_period) = (self.symmetric(a), PI / omega);
        let moved = -a * half_period / omega * phase.sin() + 2.0 * a / (omega * omega) * phase.cos();
        let (sped, pull) = (-2.0 * a / omega * phase.sin(), -a * phase.sin());
        let by_phase = [1.0 - omega * moved / speed, e * (sped - pull * moved / speed)];
        let by_speed = [-PI / speed, e * (1.0 - pull * half_period / speed)];
        1.0 + by_phase[0] + by_speed[1] + by_phase[0] * by_speed[1] - by_phase[1] * by_speed[0]
    }

    fn shaken(&self, a: f64) -> Assembly<Law> {
        let m = 0.1f64;
        let (k, zeta) = (1e10, restitution_damping(self.e));
        let law = Law::from(KelvinVoigt::new(k, 2.0 * zeta * (k * m).sqrt()).unwrap());
        let mass = || Point::OfBody { body: 0, shape: vec![m.sqrt().recip()] };
        let wall = |sides| Contact { sides, gap_m: self.half_m, law };
        let (phase_rad, speed) = self.symmetric(a);
        let force = Force::Harmonic { force_n: m * a, omega_rad_s: self.omega, phase_rad };
        Assembly {
            bodies: vec![Body::mass(m, -self.half_m, self.e * speed)],
            contacts: vec![wall([mass(), Point::Ground]), wall([Point::Ground, mass()])],
            loads: vec![Load { body: 0, shape: vec![m.sqrt().recip()], force }],
        }
    }
}

#[test]
fn a_rattling_mass_loses_its_symmetry_at_the_closed_forms_threshold() {
    let rattle = Rattle { e: 0.7, omega: 100.0 * PI, half_m: 2e-3 };
    let threshold = bisected(100.0, 200.0, |a| rattle.symmetry_margin(a) > 0.0);
    let pitchfork = |step: f64| {
        let mut settings = BranchSettings { step, ..BranchSettings::over(100.0, 160.0) };
        settings.orbit.transient_periods = 0;
        let branch = follow_branch(|a| Ok::<_, InvalidInput>(rattle.shaken(a)), &settings, &|| false).unwrap();
        let [pitchfork] = &branch.special[..] else { panic!("{:?}", branch.special) };
        assert_eq!(pitchfork.kind, Special::Pitchfork);
        assert!(branch.points.iter().all(|p| p.orbit.stable == (p.parameter < pitchfork.parameter)));
        pitchfork.clone()
    };
    let one = pitchfork(0.02);
    // a contact takes 10 us of a period of 20 ms
    assert!((one.parameter / threshold - 1.0).abs() < 2e-3, "{} {threshold}", one.parameter);
    for step in [0.011, 0.031] {
        let other = pitchfork(step);
        let apart = (other.parameter - one.parameter).abs();
        assert!(apart <= other.uncertainty + one.uncertainty && other.uncertainty < 1e-6, "{other:?} {one:?}");
    }
}

/// Beyond the pitchfork the distance from symmetry, here the middle between both ends of the motion, grows as the square root.
#[test]
fn a_branch_without_symmetry_begins_at_the_pitchfork() {
    let rattle = Rattle { e: 0.7, omega: 100.0 * PI, half_m: 2e-3 };
    let build = |a| Ok::<_, InvalidInput>(rattle.shaken(a));
    let mut settings = BranchSettings::over(130.0, 142.0);
    settings.orbit.transient_periods = 0;
    let symmetric = follow_branch(build, &settings, &|| false).unwrap();
    let branch = follow_beginning(build, &settings, &symmetric, 0, &|| false).unwrap();
    assert!(branch.complete && branch.returns_to.is_none() && branch.special.is_empty(), "{branch:?}");
    let begin = symmetric.special[0].parameter;
    let middle = |orbit: &Orbit| orbit.sides[0][0].displacement_max_m + orbit.sides[0][0].displacement_min_m;
    let near: Vec<f64> = branch.points[1..]
        .iter()
        .take_while(|point| point.parameter < begin + 0.1)
        .map(|point| middle(&point.orbit).powi(2) / (point.parameter - begin))
        .collect();
    assert!(near.len() > 3 && near.iter().all(|part| (part / near[0] - 1.0).abs() < 0.1), "{near:?}");
    assert!(branch.points[1..].iter().all(|point| point.orbit.stable && point.parameter > begin));
    // there is no second special point
    assert!(follow_beginning(build, &settings, &symmetric, 1, &|| false).is_err());
}

/// Loads of 1 and 1.5 Hz repeat themselves every 2 s. Without contact the orbit is the sum of two steady motions.
#[test]
fn loads_with_a_common_period_have_an_orbit() {
    let mut assembly = driven(0.02, 10.0, 1.0, 2.0 * PI);
    let force = Force::Harmonic { force_n: 2.0, omega_rad_s: 3.0 * PI, phase_rad: 0.1 };
    assembly.loads.push(Load { body: 0, shape: vec![1.0], force });
    let OrbitOutcome::Found(orbit) = find_orbit(&assembly, &OrbitSettings::default()).unwrap() else { panic!() };
    assert!((orbit.period_s / 2.0 - 1.0).abs() < 1e-14 && orbit.stable, "{orbit:?}");
    let gain = |omega: f64| ((100.0f64 - omega * omega).powi(2) + (0.4 * omega).powi(2)).sqrt().recip();
    let side = orbit.sides[0][1];
    assert!((side.displacement_first_harmonic_m / gain(2.0 * PI) - 1.0).abs() < 1e-9, "{side:?}");
    let most = gain(2.0 * PI) + 2.0 * gain(3.0 * PI);
    assert!(side.displacement_max_m > 0.8 * most && side.displacement_max_m < most, "{side:?} {most}");
    // Its section is the state that Newton's method has found.
    assert_eq!(orbit.section_m.len(), 1);
    assert!((orbit.section_m[0][0][1] - orbit.state[0]).abs() < 1e-12, "{orbit:?}");
}

/// A hardening frequency response: a lightly damped oscillator that reaches a stiff stop near its resonance.
fn hardening(omega: f64) -> Result<Assembly<Law>, InvalidInput> {
    let mut assembly = driven(0.02, 0.05, 0.6, omega);
    assembly.contacts[0].law = Law::from(LinearSpring::new(2000.0).unwrap());
    Ok(assembly)
}

/// At a fold a multiplier passes +1, wherever the orbits on either side lie.
#[test]
fn a_fold_is_located_in_the_step_in_which_the_parameter_turns() {
    let fold = |step: f64| {
        let settings = BranchSettings { step, longest_step: 0.02, max_orbits: 200, ..BranchSettings::over(9.0, 20.0) };
        let branch = follow_branch(hardening, &settings, &|| false).unwrap();
        branch.special.into_iter().find(|point| point.kind == Special::Fold).unwrap()
    };
    let one = fold(0.0107);
    for step in [0.01, 0.0136] {
        let fold = fold(step);
        let nearest = fold.orbit.floquet_multipliers.iter().map(|m| (m[0] - 1.0).hypot(m[1])).fold(1.0, f64::min);
        assert!(nearest < 1e-5, "{step}: {fold:?}");
        assert!((fold.parameter - one.parameter).abs() <= fold.uncertainty + one.uncertainty, "{fold:?} {one:?}");
        assert!(fold.uncertainty < 1e-10, "{fold:?}");
    }
}

#[test]
fn a_branch_passes_its_folds_and_locates_its_first_contact() {
    let mut settings = BranchSettings::over(8.0, 20.0);
    settings.step = 0.01;
    settings.longest_step = 0.02;
    settings.max_orbits = 400;
    let branch = follow_branch(hardening, &settings, &|| false).unwrap();
    // The steady motion without the stop reaches it where its amplitude equals the gap.
    let amplitude = |w: f64| 0.6 / ((100.0 - w * w).powi(2) + (0.4 * w).powi(2)).sqrt();
    let reached = bisected(8.0, 10.0, |w| amplitude(w) < 0.05);
    let grazing = branch.special.iter().find(|point| point.kind == Special::Grazing).unwrap();
    assert!((grazing.parameter - reached).abs() < 1e-3, "{grazing:?} {reached}");
    let folds: Vec<f64> = branch.special.iter().filter(|p| p.kind == Special::Fold).map(|p| p.parameter).collect();
    assert!(folds.len() >= 2 && folds[0] > 10.5, "{folds:?} {:?}", branch.special);
    assert!(branch.points.iter().any(|point| !point.orbit.stable));
}

/// A body of two modes against a damped stop. Where the motion of one period loses its stability to one with a second
/// frequency, a pair of complex multipliers has the modulus 1, which is larger on one side only.
#[test]
fn a_pair_of_multipliers_leaves_the_unit_circle_at_a_neimark_sacker_point() {
    let driven = |omega_rad_s: f64| -> Result<Assembly<Law>, InvalidInput> {
        let mode = |omega_rad_s| BodyMode { omega_rad_s, damping_ratio: 0.0255 };
        let law = Law::from(KelvinVoigt::new(81_040.0, 6.69)?);
        let tip = Point::OfBody { body: 0, shape: vec![0.376, 0.658] };
        let force = Force::Harmonic { force_n: 1.0, omega_rad_s, phase_rad: 0.0 };
        Ok(Assembly {
            bodies: vec![Body::at_rest(vec![mode(7.12), mode(17.15)])],
            contacts: vec![Contact { sides: [Point::Ground, tip], gap_m: 0.0, law }],
            loads: vec![Load { body: 0, shape: vec![0.985, 0.783], force }],
        })
    };
    let branch = follow_branch(driven, &BranchSettings::over(16.9, 17.9), &|| false).unwrap();
    let found: Vec<_> = branch.special.iter().filter(|point| point.kind == Special::NeimarkSacker).collect();
    assert_eq!(found.len(), 1, "{:?}", branch.special);
    // By the multipliers of the neighbours on the branch, between which it lies.
    let size = |k: usize| {
        let orbit: &vibroimpact_sim::assembly::Orbit = &branch.points[k].orbit;
        let complex = orbit.floquet_multipliers.iter().filter(|m| m[1] != 0.0);
        complex.map(|m| m[0].hypot(m[1])).fold(0.0, f64::max)
    };
    let [before, after] = [found[0].before_orbit - 1, found[0].before_orbit];
    let [low, high] = [before, after].map(|k| branch.points[k].parameter);
    assert!((size(before) - 1.0) * (size(after) - 1.0) < 0.0);
    let between = low + (high - low) * (1.0 - size(before)) / (size(after) - size(before));
    assert!((found[0].parameter - between).abs() < 0.1 * (high - low), "{} {between}", found[0].parameter);
    assert!(found[0].uncertainty < 1e-6);
    assert_ne!(branch.points[before].orbit.stable, branch.points[after].orbit.stable);
}

/// The map over a period begins with contacts that have forgotten the one before; where a contact has not, its fixed point is no motion.
#[test]
fn a_motion_that_depends_on_what_a_contact_keeps_from_earlier_periods_is_no_orbit() {
    let law = |law: Law, constant_n: f64, gap_m: f64| {
        let mut assembly = driven(0.05, gap_m, 1.0, 9.0);
        assembly.contacts[0].law = law;
        let force = Force::Constant { force_n: constant_n };
        assembly.loads.push(Load { body: 0, shape: vec![1.0], force });
        assembly
    };
    let thornton = |p_y: f64| Law::from(Thornton::new(1e5, 0.01, p_y).unwrap());
    let hysteretic =
        Hysteretic { stiffness_n_m1_5: 200.0, theta_m: 1.6, beta: 1.4, k_bar: 3.0, epsilon_m: 0.0 }.validated();
    let hysteretic = Law::from(hysteretic.unwrap());
    // one dents the stop ever deeper; the other never leaves it
    for assembly in [law(thornton(3e2), 0.0, 1e-3), law(hysteretic, 20.0, -0.05)] {
        let found = find_orbit(&assembly, &OrbitSettings::default()).unwrap();
        assert_eq!(found, OrbitOutcome::Remembers { contact: 0 }, "{:?}", assembly.contacts[0].law);
        let build = |_: f64| Ok::<_, InvalidInput>(assembly.clone());
        let branch = follow_branch(build, &BranchSettings::over(0.0, 1.0), &|| false).unwrap();
        assert!(branch.points.is_empty() && branch.remembers == Some(0), "{branch:?}");
    }
    // without yield nothing is kept, and a hysteretic contact that opens forgets
    let opens = law(hysteretic, 0.0, 1e-3);
    for assembly in [law(thornton(1e5), 0.0, 1e-3), law(thornton(1e5), 20.0, -0.05), opens] {
        let found = find_orbit(&assembly, &OrbitSettings::default()).unwrap();
        assert!(matches!(found, OrbitOutcome::Found(_)), "{:?} {found}", assembly.contacts[0].law);
    }
}

/// How far the state of a single body is from its repetition after three periods of an orbit, relative to its largest number. Contacts
/// keep their internal variables from period to period.
fn drift(mut assembly: Assembly<Law>, orbit: &Orbit) -> f64 {
    for load in &mut assembly.loads {
        if let Force::Harmonic { omega_rad_s, phase_rad, .. } = &mut load.force {
            *phase_rad += *omega_rad_s * orbit.phase_s;
        }
    }
    let n = orbit.state.len() / 2;
    assembly.bodies[0].amplitude = orbit.state[..n].to_vec();
    assembly.bodies[0].rate = orbit.state[n..].to_vec();
    let found = run(&assembly, &Settings::until(3.0 * orbit.period_s), &mut ()).unwrap();
    let after = found.amplitude[0].iter().chain(&found.rate[0]);
    let largest = |values: &[f64]| values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    largest(&after.zip(&orbit.state).map(|(a, b)| a - b).collect::<Vec<_>>()) / largest(&orbit.state)
}

fn hysteretic_stop(stiffness_n_m1_5: f64) -> Law {
    let law = Hysteretic { stiffness_n_m1_5, theta_m: 0.5, beta: 0.5, k_bar: 3.0, epsilon_m: 0.0 };
    law.validated().unwrap().into()
}

/// Along a branch the contact is closed at ever other moments of the period. States are then compared at another one.
#[test]
fn a_branch_is_followed_where_a_hysteretic_contact_closes_at_other_moments() {
    let build = |omega: f64| {
        let mut assembly = driven(0.05, 1e-3, 1.0, omega);
        assembly.contacts[0].law = hysteretic_stop(3e4);
        Ok::<_, InvalidInput>(assembly)
    };
    let branch = follow_branch(build, &BranchSettings::over(22.0, 9.0), &|| false).unwrap();
    assert!(branch.complete, "{:?}", branch.points.last());
    for point in branch.points.iter().filter(|point| point.orbit.stable) {
        let moved = drift(build(point.parameter).unwrap(), &point.orbit);
        assert!(moved < 1e-6, "{moved:e} {point:?}");
    }
}

/// One of two stops without a gap between them is always closed. States are compared while the one with internal variables is open.
#[test]
fn two_stops_without_a_gap_between_them_have_orbits_if_one_remembers_nothing() {
    let mut assembly = driven(0.05, 1e-3, 1.0, 5.0);
    let sides = [point(1.0), Point::Ground];
    assembly.contacts.push(Contact { sides, gap_m: -1e-3, law: hysteretic_stop(3e3) });
    let OrbitOutcome::Found(orbit) = find_orbit(&assembly, &OrbitSettings::default()).unwrap() else { panic!() };
    assert!(orbit.intervals_per_period.iter().all(|count| *count > 0), "{orbit:?}");
    let moved = drift(assembly, &orbit);
    assert!(moved < 1e-6, "{moved:e}");
}
