//! Fields that are given as distributions, and the distributions of the outputs.
//!
//! Draw `m` of a replicate `r` consists of numbers `u` from (0, 1), one for each field, from scrambled Sobol' points (`sobol.rs`)
//! or at random. Each field has the value `Q_j(u_j)` with the quantile function of its distribution. Every replicate is an
//! independent scrambling. With a statistic `theta` of the distribution (mean, standard deviation, share, index) from all draws,
//! and `theta_r` the same from replicate `r` of `R`, its standard error is
//!
//! ```text
//! s^2 = sum_r (theta_r - mean theta_r)^2 / (R (R - 1)).                                     (1)
//! ```
//!
//! A quantile is not such a statistic: where the density changes within its scatter, the quantiles of the replicates have another
//! distribution than that of all draws. The error of `Q(p)` follows from the standard error `s_p` of the share of the draws below it.
//! One part of it is the scatter `s_r` of this share by equation (1). It may be 0, because scrambled points are stratified: all
//! replicates may have the same share below `Q(p)`. The other part is the distance of the draws: the share is `p` anywhere between
//! the two draws next to the quantile, each of which is exponentially distributed about `1/N` away for `N` draws in all, so that the
//! middle between them has the standard deviation `1/(sqrt(2) N)`:
//!
//! ```text
//! s_p^2 = s_r^2 + 1/(2 N^2),                                                                (4)
//! s = ( Q(p + 2 s_p) - Q(p - 2 s_p) ) / 4.                                                  (5)
//! ```
//!
//! Two standard errors either way thus span as much as those of the share do, as for the quantiles of independent draws (David and
//! Nagaraja 2003, section 7.1). Where the distribution jumps, this interval consists of little but a gap between two neighbouring
//! draws, and the quantile may be at either side of it: `s` is then half the distance of `Q(p)` from the farther end. Where the
//! interval reaches beyond all draws, they do not tell the error.
//!
//! The indices of Sobol' show which field causes the variance `V`. Each draw is then a group of `k + 2` impacts: of two
//! independent points `a` and `b`, and of `ab_j`, which is `a` with the field `j` of `b`:
//!
//! ```text
//! S_j = mean( f(b) (f(ab_j) - f(a)) ) / V       first order (Saltelli et al. 2010)         (2)
//! T_j = mean( (f(ab_j) - f(a))^2 ) / (2 V)      total (Jansen 1999)                        (3)
//! ```
//!
//! `S_j` is the share of the variance that would vanish if field `j` were known, `T_j` the share that would remain if all others
//! were known. Draws without the output (an impact without restitution, a run that was stopped) are counted by their outcome; the
//! statistics are those of the other draws, and the indices those of the groups in which every draw has the output. If `V` is within
//! the rounding errors of the output, the output does not vary, and indices are not defined.

mod collect;
mod design;
mod distribution;
mod estimate;
mod figure;
mod file;
mod indices;
mod pictures;
mod sobol;
mod text;

pub use design::{Output, Sampling, Sequence, Uncertain};
pub use distribution::Distribution;
pub use estimate::{Histogram, OutputDistribution, Quantile};
pub use figure::Estimate;
pub use indices::SobolIndices;

pub(super) use collect::{Collector, Distributions, table};
pub(super) use file::{SamplingEntry, Told, UncertainEntry, read};
pub(super) use pictures::figures;
pub(super) use text::text;
