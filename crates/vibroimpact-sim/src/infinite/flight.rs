//! Free flight between contacts, in closed form.
//!
//! Apart, the body moves with its constant speed `u` (towards the structure) and the struck
//! point goes on as `sum_j w_j sqrt(d_j + tau)`, `d_j` being the ages of the impulses at
//! separation. The compression (negative: a gap) is `x(tau) = tau q(tau)` with
//!
//! ```text
//! q(tau) = u - sum_j w_j / (sqrt(d_j + tau) + sqrt(d_j)),
//! ```
//!
//! which increases from `x'(0) < 0` to `u` and is concave, because every `w_j > 0`. Hence: there
//! is exactly one next contact if `u > 0`, and none otherwise. No sampling is involved, nothing
//! can be missed. A plate stays where the last contact left it, so there `q = u < 0`.

use super::history::Impulse;

/// Time until the surfaces meet again and the closing speed then; `None` if they never do.
pub(super) fn next_contact(u: f64, past: &[Impulse]) -> Option<(f64, f64)> {
    let total: f64 = past.iter().map(|i| i.weight).sum();
    if !(u > 0.0 && total > 0.0) {
        return None;
    }
    let roots: Vec<(f64, f64, f64)> = past.iter().map(|i| (i.age, i.age.sqrt(), i.weight)).collect();
    let gap_rate = |tau: f64| {
        let (mut sum, mut slope) = (0.0, 0.0);
        for &(age, root, weight) in &roots {
            let now = (age + tau).sqrt();
            let term = weight / (now + root);
            sum += term;
            slope += term / (2.0 * now * (now + root));
        }
        (u - sum, slope)
    };
    // q is concave in tau: Newton from the left never passes the root. In y = tau^(-1/2) it is
    // convex and decreasing: Newton from y = u / total (a time not before the root) neither.
    // The two sequences enclose the root.
    let (mut early, mut late) = (0.0_f64, (total / u).powi(2));
    let mut tau = late;
    for _ in 0..200 {
        let (q, slope) = gap_rate(early);
        let advanced = early - q / slope;
        let (q, slope) = gap_rate(late);
        let pulled = (late.sqrt().recip() + q / (2.0 * late * late.sqrt() * slope)).powi(-2);
        if !(advanced > early && advanced < late) {
            tau = early;
            break;
        }
        tau = late;
        if !(pulled < late && pulled > early) {
            break;
        }
        (early, late) = (advanced, pulled);
    }
    let (_, slope) = gap_rate(tau);
    (tau > 0.0 && slope > 0.0).then_some((tau, tau * slope))
}

/// Compression (below zero) and its rate, `tau` after separation.
pub(super) fn state(u: f64, past: &[Impulse], tau: f64) -> (f64, f64) {
    let (mut gap, mut rate) = (u * tau, u);
    for i in past {
        let now = (i.age + tau).sqrt();
        gap -= i.weight * tau / (now + i.age.sqrt());
        rate -= i.weight / (2.0 * now);
    }
    (gap, rate)
}

/// The least compression of the flight, or minus infinity if the gap opens for ever.
pub(super) fn least_compression(u: f64, past: &[Impulse]) -> f64 {
    if u <= 0.0 {
        return f64::NEG_INFINITY;
    }
    // the rate is concave and increasing: Newton from the left, as above
    let mut tau = 0.0_f64;
    for _ in 0..200 {
        let (_, rate) = state(u, past, tau);
        let bend: f64 = past.iter().map(|i| 0.25 * i.weight / (i.age + tau).powf(1.5)).sum();
        let next = tau - rate / bend;
        if !(next > tau * (1.0 + 1e-12)) {
            break;
        }
        tau = next;
    }
    state(u, past, tau).0.min(0.0)
}
