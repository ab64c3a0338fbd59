//! The drops of both tables, and the law that is fitted to them.

use crate::beam::{Ball, Bar, LENGTH_M, Law};
use std::error::Error;

/// A light ball, a medium one, and a heavy one.
pub const BALLS: [Ball; 3] = [Ball { radius_m: 0.008 }, Ball { radius_m: 0.014 }, Ball { radius_m: 0.02 }];
/// Locations to which the law is fitted.
const FITTED: usize = 30;
/// Locations from a support to the middle at which it is compared; none of them was used in the fit.
pub const COMPARED: usize = 8;
/// Height of fall (m): 3.1 m/s.
pub const DROP_M: f64 = 0.5;

/// The law, fitted to all balls.
pub fn fitted(bar: &Bar) -> Result<Law, Box<dyn Error>> {
    let locations: Vec<f64> = (1..=FITTED).map(|i| LENGTH_M * i as f64 / (FITTED + 1) as f64).collect();
    bar.law(&BALLS, &locations, DROP_M)
}
