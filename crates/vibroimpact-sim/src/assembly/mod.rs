//! Many bodies, contacts and loads over long times.

mod problem;
mod solution;

pub use problem::{Assembly, Body, BodyMode, Contact, Force, Load, Point, Settings};
pub use solution::{
    ContactEnd, ContactSample, Counts, Interval, Ledger, Motion, Observer, Outcome, Reason, Run, Statistics,
};
