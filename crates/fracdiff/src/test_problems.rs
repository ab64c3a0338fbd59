//! Test problems with known solutions, shared by tests, benches and work-precision studies.
//!
//! Reference values were computed with 50 digits and are exact to the last digit printed.

// The reference values have all the digits that were computed.
#![allow(clippy::excessive_precision)]

use crate::collocation::Collocation;
use crate::convolution::Convolution;
use crate::exponential::{GalerkinStates, SumOfExponentials};
use crate::method::Method;
use crate::problem::{Term, Volterra};
use libm::tgamma;
use std::f64::consts::PI;

/// A problem with one unknown and its known values.
#[derive(Debug)]
pub struct TestProblem {
    /// Short name.
    pub name: &'static str,
    /// The equation and its source.
    pub about: &'static str,
    /// The problem.
    pub volterra: Volterra<'static>,
    /// Times and values of the solution, ascending in time.
    pub reference: Vec<(f64, f64)>,
}

impl TestProblem {
    /// The final time to use: the last reference time not beyond `limit`, or the first one.
    pub fn end_before(&self, limit: f64) -> f64 {
        let mut inside = self.reference.iter().map(|r| r.0).filter(|&t| t <= limit);
        inside.next_back().or(self.reference.first().map(|r| r.0)).unwrap_or(limit)
    }
}

/// First zero of the [`linear_beam`] and the slope there.
pub const LINEAR_BEAM_ZERO: (f64, f64) = (2.5701454794074989, -0.5065175615322355);

/// End of the contact of [`rigid_contact`].
pub const RIGID_CONTACT_END: f64 = 3.2180654597190430845;

/// Largest compression of [`rigid_contact`].
pub const RIGID_CONTACT_LARGEST: f64 = 1.0933620739432780564;

/// Every problem of the module.
pub fn all() -> Vec<TestProblem> {
    vec![
        relaxation(),
        oscillation(),
        bagley_torvik(),
        abel(),
        diethelm(0.5),
        linear_beam(),
        rigid_contact(),
        manufactured_contact(),
    ]
}

/// Every method of the crate, in the order of [`Method`]; those with steps have this many.
pub fn every_method(steps: usize) -> Vec<Method> {
    vec![
        Method::GrunwaldLetnikov(Convolution { steps }),
        Method::L1(Convolution { steps }),
        Method::Trapezoidal(Convolution { steps }),
        Method::SumOfExponentials(SumOfExponentials { steps, ..Default::default() }),
        Method::GalerkinStates(GalerkinStates { steps, ..Default::default() }),
        Method::Collocation(Collocation::default()),
    ]
}

/// `D^(1/2) y = -y`, `y(0) = 1`: the Mittag-Leffler function `E_(1/2)(-sqrt t)`.
pub fn relaxation() -> TestProblem {
    TestProblem {
        name: "relaxation",
        about: "D^(1/2) y = -y, y(0) = 1",
        volterra: Volterra::scalar(|_| 1.0, |_, y| y, &[(0.5, -1.0 / tgamma(0.5))]),
        reference: vec![(1.0, 0.42758357615580700), (100.0, 0.056140992743822586), (1e6, 5.641893014533877e-4)],
    }
}

/// `D^(3/2) y = -y`, `y(0) = 1`, `y'(0) = 0`: `E_(3/2)(-t^(3/2))`.
pub fn oscillation() -> TestProblem {
    TestProblem {
        name: "oscillation",
        about: "D^(3/2) y = -y, y(0) = 1, y'(0) = 0",
        volterra: Volterra::scalar(|_| 1.0, |_, y| y, &[(1.5, -1.0 / tgamma(1.5))]),
        reference: vec![(1.0, 0.39662936531808809), (5.0, -0.064447308950367077), (50.0, -7.9780087584332e-4)],
    }
}

/// `y'' + D^(3/2) y + y = 8` until `t = 1` and 0 after (Bagley & Torvik 1984), at rest at first.
pub fn bagley_torvik() -> TestProblem {
    let terms = vec![Term::riemann_liouville(0, 0, 2.0, 1.0), Term::riemann_liouville(0, 1, 0.5, -1.0)];
    TestProblem {
        name: "bagley-torvik",
        about: "y'' + D^(3/2) y + y = 8 [t <= 1], y(0) = y'(0) = 0",
        volterra: Volterra {
            unknowns: 1,
            densities: 2,
            terms,
            forcing: Box::new(|_, g| g.fill(0.0)),
            density: Box::new(|t, y, f| {
                if let (&[y], [load, copy]) = (y, f) {
                    *load = if t <= 1.0 { 8.0 - y } else { -y };
                    *copy = y;
                }
            }),
            breaks: vec![1.0],
            events: Vec::new(),
        },
        reference: vec![(1.0, 2.3155258227925759), (5.0, -0.45564134053840937), (20.0, 0.18737515694206304)],
    }
}

/// Abel's equation `y = 1 - int (t-s)^(-1/2) y ds`: `exp(pi t) erfc(sqrt(pi t))`.
pub fn abel() -> TestProblem {
    TestProblem {
        name: "abel",
        about: "y = 1 - int (t-s)^(-1/2) y ds",
        volterra: Volterra::scalar(|_| 1.0, |_, y| y, &[(0.5, -1.0)]),
        reference: vec![(1.0, 0.28205917617568265)],
    }
}

/// The nonlinear problem of Diethelm with solution `t^8 - 3 t^(4+b/2) + (9/4) t^b` for the order `b` between 0 and 1.
pub fn diethelm(b: f64) -> TestProblem {
    let exact = move |t: f64| t.powi(8) - 3.0 * t.powf(4.0 + 0.5 * b) + 2.25 * t.powf(b);
    let right = move |t: f64, y: f64| {
        40320.0 / tgamma(9.0 - b) * t.powf(8.0 - b)
            - 3.0 * tgamma(5.0 + 0.5 * b) / tgamma(5.0 - 0.5 * b) * t.powf(4.0 - 0.5 * b)
            + 2.25 * tgamma(b + 1.0)
            + (1.5 * t.powf(0.5 * b) - t.powi(4)).powi(3)
            - y.abs().powf(1.5)
    };
    TestProblem {
        name: "diethelm",
        about: "D^b y = known(t) - y^(3/2), y = t^8 - 3 t^(4+b/2) + (9/4) t^b",
        volterra: Volterra::scalar(|_| 0.0, right, &[(b, 1.0 / tgamma(b))]),
        reference: [0.25, 0.5, 0.75, 1.0].iter().map(|&t| (t, exact(t))).collect(),
    }
}

/// Linear analogue of a ball on an infinite beam: `x = t - int [(t-s) + sqrt(t-s)] x ds`.
pub fn linear_beam() -> TestProblem {
    TestProblem {
        name: "linear-beam",
        about: "x = t - int [(t-s) + sqrt(t-s)] x ds",
        volterra: Volterra::scalar(|t| t, |_, x| x, &[(2.0, -1.0), (1.5, -1.0)]),
        reference: vec![(1.0, 0.6347269613345202), (2.0, 0.3235220381803619), (100.0, 2.4693372605732e-4)],
    }
}

/// Hertzian contact with a rigid support: `x = t - int (t-s) max(x, 0)^(3/2) ds`; leaves at unit speed.
pub fn rigid_contact() -> TestProblem {
    let end = RIGID_CONTACT_END;
    TestProblem {
        name: "rigid-contact",
        about: "x = t - int (t-s) max(x,0)^(3/2) ds",
        volterra: Volterra::scalar(|t| t, |_, x| x.max(0.0).powf(1.5), &[(2.0, -1.0)]),
        reference: vec![(0.5 * end, RIGID_CONTACT_LARGEST), (end, 0.0), (5.0, end - 5.0)],
    }
}

/// A given force `(t(1-t))^(3/2)` up to `t = 1`, none after: `y = int sqrt(t-s) force ds`, a test of the memory alone.
pub fn manufactured_contact() -> TestProblem {
    let force = |t: f64, _: f64| (t * (1.0 - t)).max(0.0).powf(1.5);
    TestProblem {
        name: "manufactured-contact",
        about: "y = int sqrt(t-s) (s(1-s))_+^(3/2) ds",
        volterra: Volterra::scalar(|_| 0.0, force, &[(1.5, 1.0)]).with_breaks(&[1.0]),
        reference: vec![
            (0.5, 0.014120218079899651),
            (1.0, 16.0 / 315.0),
            (10.0, 0.22693312224317404),
            (1e6, 73.63105941073864),
        ],
    }
}

/// A Hertzian ball on an infinite beam, `x = t - int [(t-s) + sqrt(t-s)] sqrt(S) max(x, 0)^(3/2) ds` (thesis Eqs. 2.7 in units
/// in which only `S` remains). It has no closed solution and is not among [`all`]; with `S = 15` the ball separates four times
/// and then stays in contact (thesis Fig. 2.3).
pub fn ball_on_beam(s: f64) -> Volterra<'static> {
    Volterra::scalar(|t| t, move |_, x| s.sqrt() * x.max(0.0).powf(1.5), &[(2.0, -1.0), (1.5, -1.0)])
}

/// The solution of [`abel`] for `t >= 0`.
pub fn abel_exact(t: f64) -> f64 {
    // exp(z^2) erfc(z)
    puruspe::erfcx((PI * t).sqrt())
}
