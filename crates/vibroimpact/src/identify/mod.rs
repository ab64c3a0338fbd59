//! Parameters of a scene from measurements, by resolved impacts.
//!
//! Each row of a table of measurements describes one impact: the fields of the scene that were varied, and the measured values.
//! Free fields of the scene are the parameters `p`; the search uses logarithms `u = ln p` (or a logistic coordinate between two
//! stated limits). With the predictions `y_i(p)` from the resolved impact of row `i` and the standard deviations `s_i` of the
//! measurements `m_i`, the sum of squares is minimised:
//!
//! ```text
//! r_i(p) = (y_i(p) - m_i) / s_i,        S(p) = sum r_i^2  ->  least.                                      (1)
//! ```
//!
//! Where no standard deviations are stated, each measured quantity has one, which is estimated with the parameters: fits and
//! estimates `s_q^2 = S_q / f_q` alternate until they agree. The degrees of freedom `f_q` of a quantity are the number of its
//! values minus their leverage, Eq. (4).
//!
//! **Force histories.** A gauge whose clock has the offset `d` and whose response has the time constant `T` records
//!
//! ```text
//! m(t) = f(t - d) + noise,        T f' + f = F,                                                           (2)
//! ```
//!
//! with the contact force `F`. For each history the offset `d` that minimises `S` is found separately and eliminated (variable
//! projection, Golub and Pereyra 1973): with `q` the unit vector along `dr/dd`, the Jacobian is `J - q q^T J`.
//!
//! **One model.** The number of modes is chosen once, at the starting values, as the largest number that a row of the table needs.
//! It is then fixed, because `S` would jump if the number depended on the parameters.
//!
//! **Many minima.** Where contacts split or join, predictions jump, and `S` has many minima. The search ranks points by
//! `sum ln(1 + r_i^2)`, in which rows that jump count little (Cauchy's likelihood). A quarter of the points are quasi-random over
//! the intervals of the search; the others are drawn around the best so far, in ten stages with a shrinking spread
//! ([`fitting::Settings::candidates`]). The search continues from the best points that are apart from each other with the same
//! sum, and ends with Eq. (1) from the best four minima.
//!
//! **Intervals.** With `M = J^T J` the interval of a parameter is `u +- z sqrt((M^-1)_jj)`, and by the likelihood
//! profile `S_j(u) <= S + z^2` ([`fitting::profile`]), which also holds if `S` is not quadratic. The quantile `z` is the normal one
//! for stated standard deviations, and Student's for estimated ones. Its degrees of freedom are those of Welch (1947) and
//! Satterthwaite (1946): with `v_q` the part of quantity `q` in the variance of the parameter,
//!
//! ```text
//! f = (sum v_q)^2 / sum(v_q^2 / f_q),        v_q = sum_(i in q) (C J^T)_ji^2,        C = M^-1,             (3)
//! f_q = sum_(i in q) (1 - (J C J^T)_ii).                                                                  (4)
//! ```
//!
//! A parameter that a single quantity determines has only the degrees of freedom of that quantity.
//!
//! Eigenvectors of `M` are the combinations that the data determine independently. Combinations with a large standard deviation
//! are reported as not determined. For the parameters in them, the information `M_aa - M_ab M_bb^-1 M_ba` that remains if the others
//! are unknown too shows which products of their powers are determined. `S` follows the chi-square distribution with `m - n` degrees of freedom if the model is right.
//! The value of a further measurement is the amount that it adds to `ln det M` ([`fitting::Information`]).
//!
//! | symbol | meaning |
//! |---|---|
//! | `m`, `n` | number of measured values (minus one for each force history), number of parameters |
//! | `z` | quantile: normal for stated standard deviations, Student's with `f` degrees for estimated ones |
//! | `J` | Jacobian `dr/du` |

mod data;
mod derivative;
mod design;
mod determined;
mod estimate;
mod forward;
mod free;
mod freedom;
mod gauge;
mod judge;
#[cfg(feature = "files")]
mod picture;
mod quantity;
mod summary;
mod text;
mod work;

pub use data::Data;
pub use estimate::{MOST_STARTS, Request, identify};
pub use free::Free;
pub use gauge::ForceRecord;
#[cfg(feature = "files")]
pub use picture::picture;
pub use quantity::Quantity;
pub use summary::{
    Candidate, Combination, Identification, Identified, LackOfFit, Noise, Predicted, ProfileCurve, RecordFit,
    StartFound, Undetermined,
};
pub use text::text;
