//! Beyond the thesis: its impacts by Timoshenko's and by Euler-Bernoulli's theory, both with enough modes for convergence.
//!
//! A wave `e^(i(kx - omega t))` of a beam of thickness `h` runs at `c = omega/k`. With `X = (c/c_s)^2`, `c_s^2 = G/rho`,
//! `g = (kh)^2/12` and Poisson's ratio `nu`, Euler-Bernoulli's and Timoshenko's theory (shear coefficient `kappa`) give
//!
//! ```text
//! X = 2 (1 + nu) g,                                                                                               (1)
//! (g/kappa) X^2 - (1 + g (1 + 2 (1 + nu)/kappa)) X + 2 (1 + nu) g = 0,  the smaller root,                         (2)
//! ```
//!
//! and elasticity in two dimensions (plane stress, free faces at `y = +-h/2`) gives, on the lowest antisymmetric branch of
//! Rayleigh (1889) and Lamb (1917), with `a^2 = 1 - X (1 - nu)/2`, `b^2 = 1 - X`, `H = kh/2`,
//!
//! ```text
//! (2 - X)^2 tanh(a H) = 4 a b tanh(b H).                                                                          (3)
//! ```
//!
//! Usual shear coefficients of a rectangle:
//!
//! ```text
//! kappa = 5/6                              E. Reissner, J. Appl. Mech. 12 (1945) A69
//!         10 (1 + nu)/(12 + 11 nu)         G. R. Cowper, J. Appl. Mech. 33 (1966) 335
//!         5 (1 + nu)/(6 + 5 nu)            T. Kaneko, J. Phys. D 8 (1975) 1927; (2) and (3) then agree to order g^2
//!         0.8723, a square, nu = 0.3       J. R. Hutchinson, J. Appl. Mech. 68 (2001) 87, in three dimensions.      (4)
//! ```

mod balls;
mod coefficients;
mod law;
mod phase_speeds;
mod predictable;
mod tables;

use super::study::Study;
use super::{chapter3, chapter4};
pub(super) use coefficients::kaneko;
use coefficients::{APART, Coefficient, coefficients};
use tasks::Failure;

const INTRODUCTION: &str = "This report solves the impacts of chapters 3, 4 and 7 by Timoshenko's theory and compares \
them with Euler-Bernoulli's theory, which the thesis uses. Unless stated otherwise, remainder modes represent all \
truncated modes, so that converged restitutions are compared, and the shear coefficient is 5(1+ν)/(6+5ν). *Truncation* \
is the change by plain truncation at N = 40, as in the thesis. *Theory* is the difference of the two theories. \
*Coefficient* is the change by ± 2 % of the shear coefficient in Timoshenko's theory.";

/// Runs the study and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let (beam, beams) = (chapter3::Case::load()?, chapter4::Case::load()?);
    phase_speeds::run(study, &beam)?;
    balls::run(study, &beam)?;
    predictable::run(study, &beam)?;
    let thick = tables::Thick::of(&beams)?;
    let tables = tables::run(study, &beams, &thick)?;
    law::run(study, &tables)?;
    Ok(INTRODUCTION)
}
