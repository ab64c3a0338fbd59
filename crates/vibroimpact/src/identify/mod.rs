//! Parameters of a scene from measurements, by resolved impacts.
//!
//! A table of measurements holds one impact a row: the fields of the scene that were varied, and what was measured. Free
//! fields of the scene are the parameters `p`, sought in logarithms `u = ln p` (or in a logistic coordinate between two
//! stated limits). With the impact of row `i` resolved, `y_i(p)` its predictions and `s_i` the standard deviations of
//! the measurements `m_i`,
//!
//! ```text
//! r_i(p) = (y_i(p) - m_i) / s_i,        S(p) = sum r_i^2  ->  least.                                      (1)
//! ```
//!
//! Where no standard deviations are stated, each measured quantity has one, which is estimated with the parameters: fits and
//! estimates `s_q^2 = S_q / f_q` alternate until they agree. The degrees of freedom `f_q` of a quantity are its values less their
//! leverage, Eq. (4).
//!
//! **Force histories.** A gauge whose clock is off by `d` and whose response has the time constant `T` shows
//!
//! ```text
//! m(t) = f(t - d) + noise,        T f' + f = F,                                                           (2)
//! ```
//!
//! `F` the contact force. For each history the offset `d` that makes `S` least is found apart and eliminated (variable
//! projection, Golub and Pereyra 1973): with `q` the unit vector along `dr/dd`, the Jacobian is `J - q q^T J`.
//!
//! **One model.** The number of modes is chosen once, at the starting values, as the most that a row of the table needs, and kept: with a
//! number that followed the parameters, `S` would jump.
//!
//! **Many minima.** Where contacts split or join, predictions jump, and `S` has many minima. The search ranks quasi-random points by
//! `sum ln(1 + r_i^2)`, in which rows that jump count little (Cauchy's likelihood), goes on from the best of them by the same
//! sum, and ends with Eq. (1).
//!
//! **What the data say.** With `M = J^T J` the interval of a parameter is `u +- z sqrt((M^-1)_jj)`, and by the likelihood
//! profile `S_j(u) <= S + z^2` ([`fitting::profile`]), which also holds where `S` is no parabola. The quantile `z` is the normal one
//! for stated standard deviations, and Student's for estimated ones. Its degrees of freedom are those of Welch (1947) and
//! Satterthwaite (1946): with `v_q` the part of quantity `q` in the variance of the parameter,
//!
//! ```text
//! f = (sum v_q)^2 / sum(v_q^2 / f_q),        v_q = sum_(i in q) (C J^T)_ji^2,        C = M^-1,             (3)
//! f_q = sum_(i in q) (1 - (J C J^T)_ii).                                                                  (4)
//! ```
//!
//! A parameter that a single quantity determines has only the freedom of that quantity.
//!
//! Eigenvectors of `M` are the combinations that the data determine each by itself; those whose standard deviation is large they
//! leave open.
//! `S` follows chi-square with `m - n` degrees of freedom if the model is right. A further measurement is worth what it adds to
//! `ln det M` ([`fitting::Information`]).
//!
//! | symbol | meaning |
//! |---|---|
//! | `m`, `n` | number of measured values (less one for each force history), of parameters |
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
pub use estimate::{Request, identify};
pub use free::Free;
pub use gauge::ForceRecord;
#[cfg(feature = "files")]
pub use picture::picture;
pub use quantity::Quantity;
pub use summary::{
    Candidate, Identification, Identified, LackOfFit, Noise, Predicted, ProfileCurve, RecordFit, StartFound,
    Undetermined,
};
pub use text::text;
