//! The problems: modes, contacts and loads with known parameters, as the engine takes them and as a general solver does.

use beam_modes::{Beam, BeamSystem, End, Segment, ShearSection};
use contact_models::{Hertz, HuntCrossley, Law, LinearSpring};
use std::f64::consts::PI;
use vibroimpact_sim::assembly::{Assembly, Body, BodyMode, Contact, Force, Load, Point};

/// The force of a closed contact, `stiffness xi^exponent (1 + damping xi')`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    /// Stiffness (N/m^exponent).
    pub stiffness: f64,
    /// 1 or 3/2.
    pub exponent: f64,
    /// Damping (s/m); 0 with the exponent 1.
    pub damping_s_m: f64,
}

impl Power {
    fn law(self) -> Result<Law, String> {
        let Power { stiffness, exponent, damping_s_m } = self;
        let law = match (exponent == 1.0, damping_s_m == 0.0) {
            (true, _) => LinearSpring::new(stiffness).map(Law::from),
            (false, true) => Hertz::new(stiffness).map(Law::from),
            (false, false) => HuntCrossley::new(stiffness, exponent, damping_s_m).map(Law::from),
        };
        law.map_err(|fault| fault.to_string())
    }
}

/// One of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Short name.
    pub name: &'static str,
    /// What it is.
    pub about: &'static str,
    /// The bodies, contacts and loads.
    pub assembly: Assembly<Law>,
    /// The laws of the contacts.
    pub laws: Vec<Power>,
    /// When the run ends (s).
    pub end_s: f64,
}

fn text(fault: impl std::fmt::Display) -> String {
    fault.to_string()
}

/// A body of these modes, all with one damping ratio.
fn body(omega_rad_s: &[f64], damping: impl Fn(f64) -> f64) -> Body {
    let mode = |&omega_rad_s: &f64| BodyMode { omega_rad_s, damping_ratio: damping(omega_rad_s) };
    Body::at_rest(omega_rad_s.iter().map(mode).collect())
}

fn on(body: usize, shape: Vec<f64>) -> Point {
    Point::OfBody { body, shape }
}

fn contact(sides: [Point; 2], gap_m: f64, law: Power) -> Result<Contact<Law>, String> {
    Ok(Contact { sides, gap_m, law: law.law()? })
}

/// Code_Aster's SDNL104: the tip of a cantilever under a force above an elastic stop, 40 modes.
fn cantilever_above_a_stop() -> Result<Problem, String> {
    let diameter: f64 = 0.2;
    let segment = Segment {
        length_m: 1.0,
        flexural_rigidity_n_m2: 1e10 * PI * diameter.powi(4) / 64.0,
        mass_per_length_kg_m: 1e6 * PI * diameter.powi(2) / 4.0,
    };
    let modes = Beam { segments: vec![segment], ends: [End::Clamped, End::Free] }.modes(40).map_err(text)?;
    let tip = modes.shapes_at(1.0).map_err(text)?;
    let law = Power { stiffness: 1e8, exponent: 1.0, damping_s_m: 0.0 };
    let assembly = Assembly {
        bodies: vec![body(modes.omega_rad_s(), |_| 0.0)],
        contacts: vec![contact([on(0, tip.clone()), Point::Ground], 1e-4, law)?],
        loads: vec![Load { body: 0, shape: tip, force: Force::Constant { force_n: -1000.0 } }],
    };
    let about = "SDNL104: a cantilever above a stop, 40 modes, 1 contact, 0.16 s";
    Ok(Problem { name: "SDNL104", about, assembly, laws: vec![law], end_s: 0.16 })
}

/// Code_Aster's SDNL105: three tubes side by side, 10 modes each.
fn three_tubes() -> Result<Problem, String> {
    let (outer, inner): (f64, f64) = (0.1, 0.09);
    let segment = Segment {
        length_m: 1.0,
        flexural_rigidity_n_m2: 1e10 * PI / 4.0 * (outer.powi(4) - inner.powi(4)),
        mass_per_length_kg_m: 1e8 * PI * (outer.powi(2) - inner.powi(2)),
    };
    let modes = Beam { segments: vec![segment], ends: [End::Clamped; 2] }.modes(10).map_err(text)?;
    let middle = modes.shapes_at(0.5).map_err(text)?;
    let law = Power { stiffness: 1e8, exponent: 1.0, damping_s_m: 0.0 };
    let between = |a: usize, b: usize| contact([on(a, middle.clone()), on(b, middle.clone())], 1e-3, law);
    let assembly = Assembly {
        bodies: vec![body(modes.omega_rad_s(), |_| 0.0); 3],
        contacts: vec![between(1, 0)?, between(2, 1)?],
        loads: vec![Load { body: 0, shape: middle.clone(), force: Force::Constant { force_n: 1e6 } }],
    };
    let about = "SDNL105: three tubes side by side, 30 modes, 2 contacts, 1 s";
    Ok(Problem { name: "SDNL105", about, assembly, laws: vec![law; 2], end_s: 1.0 })
}

/// Code_Aster's SDNL301 without the dashpots of its supports: a tube in four loose supports with two sides each.
fn tube_in_supports() -> Result<Problem, String> {
    let (outer, inner): (f64, f64) = (0.00795, 0.0068);
    let (area, inertia) = (PI * (outer.powi(2) - inner.powi(2)), PI / 4.0 * (outer.powi(4) - inner.powi(4)));
    let span = 0.609;
    let segment = Segment {
        length_m: 4.0 * span,
        flexural_rigidity_n_m2: 2.07e11 * inertia,
        mass_per_length_kg_m: 7870.0 * area,
    };
    // Cowper's coefficient of this section
    let shear = ShearSection { shear_rigidity_n: 0.532 * 2.07e11 / 2.6 * area, rotary_inertia_kg_m: 7870.0 * inertia };
    let beam = Beam { segments: vec![segment], ends: [End::Clamped, End::Free] };
    let modes = BeamSystem { shear: Some(vec![shear]), ..BeamSystem::from(beam) }.modes(30).map_err(text)?;
    let shapes = |x_m: f64| modes.shapes_at(x_m).map_err(text);
    let mut pushed = vec![0.0; 30];
    for part in (0..48).filter(|part| part % 12 != 0) {
        let sign = if part / 12 % 2 == 0 { 1.0 } else { -1.0 };
        for (sum, shape) in pushed.iter_mut().zip(shapes(span * f64::from(part) / 12.0)?) {
            *sum += sign * shape;
        }
    }
    let law = Power { stiffness: 1e5, exponent: 1.0, damping_s_m: 0.0 };
    let mut contacts = Vec::new();
    for support in 1..=4 {
        let point = || Ok::<_, String>(on(0, shapes(span * f64::from(support))?));
        contacts.push(contact([point()?, Point::Ground], 0.406e-3, law)?);
        contacts.push(contact([Point::Ground, point()?], 0.406e-3, law)?);
    }
    let rayleigh = |omega: f64| 0.5 * (0.1526 / omega + 1.79e-5 * omega);
    let force = Force::Harmonic { force_n: 4.138, omega_rad_s: 251.2, phase_rad: 0.0 };
    let assembly = Assembly {
        bodies: vec![body(modes.omega_rad_s(), rayleigh)],
        contacts,
        loads: vec![Load { body: 0, shape: pushed, force }],
    };
    let about = "SDNL301 without dashpots: a tube in loose supports, 30 modes, 8 contacts, a harmonic load, 0.25 s";
    Ok(Problem { name: "SDNL301", about, assembly, laws: vec![law; 8], end_s: 0.25 })
}

/// A ball that bounces on a pinned beam under its weight.
fn bouncing_ball() -> Result<Problem, String> {
    let segment = Segment::rectangular(1.0, 2e11, 7800.0, 0.011323, 0.011323);
    let modes = Beam { segments: vec![segment], ends: [End::Pinned; 2] }.modes(20).map_err(text)?;
    let place = modes.shapes_at(0.4).map_err(text)?;
    let mass_kg: f64 = 0.11027;
    let weight = |body: usize, shape: Vec<f64>| Load { body, shape, force: Force::Constant { force_n: -9.81 } };
    let law = Power { stiffness: 1.7945e10, exponent: 1.5, damping_s_m: 1.0 };
    let assembly = Assembly {
        bodies: vec![Body::mass(mass_kg, 0.005, 0.0), body(modes.omega_rad_s(), |_| 0.02)],
        contacts: vec![contact([on(0, vec![mass_kg.sqrt().recip()]), on(1, place)], 0.0, law)?],
        loads: vec![weight(0, vec![mass_kg.sqrt()]), weight(1, modes.participation_kg0_5())],
    };
    let about = "a ball bounces on a beam: 21 modes, 1 contact by Hunt and Crossley, gravity, 0.25 s";
    Ok(Problem { name: "bouncing ball", about, assembly, laws: vec![law], end_s: 0.25 })
}

/// Five balls in a row, each in touch with the next, and a sixth that strikes the first.
fn cradle() -> Result<Problem, String> {
    let mass_kg: f64 = 0.1;
    let side = |body: usize| on(body, vec![mass_kg.sqrt().recip()]);
    let law = Power { stiffness: 1e10, exponent: 1.5, damping_s_m: 0.0 };
    let ball = |i: usize| Body::mass(mass_kg, 0.0, if i == 0 { 1.0 } else { 0.0 });
    let assembly = Assembly {
        bodies: (0..6).map(ball).collect(),
        contacts: (0..5).map(|i| contact([side(i + 1), side(i)], 0.0, law)).collect::<Result<_, _>>()?,
        loads: vec![],
    };
    let about = "Newton's cradle: 6 balls, 5 contacts by Hertz, 1 ms";
    Ok(Problem { name: "cradle", about, assembly, laws: vec![law; 5], end_s: 1e-3 })
}

/// All problems.
///
/// # Errors
/// None that these numbers could cause.
pub fn library() -> Result<Vec<Problem>, String> {
    Ok(vec![cantilever_above_a_stop()?, three_tubes()?, tube_in_supports()?, bouncing_ball()?, cradle()?])
}
