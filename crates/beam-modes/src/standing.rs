//! Standing waves on a uniform beam between pinned or guided ends.
//!
//! Such ends reflect every sine or cosine into itself. `w = sin k x` from a pinned end and `w = cos k x` from a guided one, with
//! `k L = n pi` between like and `(n - 1/2) pi` between unlike ends, are therefore modes of either theory, without a search. Each has
//! the frequencies of its wave number, with the shear flexibility `s = 1/(kappa G A)` and the axial force `T`:
//!
//! ```text
//! s rho I m omega^4 - (m (1 + s EI k^2) + rho I k^2) omega^2 + EI k^4 + T k^2 = 0.
//! ```
//!
//! With shear and rotary inertia there are two, the second of which is that of the second spectrum. If the displacement has the amplitude
//! 1, the rotation of the sections has the amplitude `X/k`, where `X = k^2 - s m omega^2` is the positive root of
//!
//! ```text
//! rho I X^2 - k^2 (rho I - s m EI) X - s m^2 omega^2 = 0,
//! ```
//!
//! and the negative one in the second spectrum. Between pinned ends the sections can also rotate alike without displacement, at
//! `omega^2 = 1/(s rho I)`.

use std::f64::consts::PI;

use crate::definition::End;
use crate::piece::Piece;
use crate::span::Span;
use crate::superposition::Second;

/// A mode: its frequency, and its shape.
pub(crate) type Wave = (f64, Piece);

/// The two squared frequencies of a wave number; the second is infinite if there is no second spectrum.
fn squared_frequencies(span: &Span, k: f64) -> [f64; 2] {
    let &Span { rigidity, mass, shear, rotary, tension, .. } = span;
    let square = k * k;
    let (translation, rotation) = (mass * (1.0 + shear * rigidity * square), rotary * square);
    // the root of the discriminant, without cancellation
    let root = (translation - rotation).hypot(2.0 * (mass * rotation).sqrt());
    let sum = translation + rotation + root;
    [2.0 * square * (rigidity * square + tension) / sum, 0.5 * sum / (shear * mass * rotary)]
}

/// Both roots of `a x^2 - b x - c = 0` for `a, c >= 0`, the positive one first, without cancellation.
fn roots_of_both_signs(a: f64, b: f64, c: f64) -> [f64; 2] {
    let sum = b.abs() + b.hypot(2.0 * (a * c).sqrt());
    let (one, other) = (0.5 * sum / a, 2.0 * c / sum);
    if b < 0.0 { [other, -one] } else { [one, -other] }
}

/// The wave of this number and squared frequency in the first (0) or the second spectrum (1).
fn wave(span: &Span, starts_pinned: bool, k: f64, squared: f64, spectrum: usize) -> Wave {
    let &Span { length, rigidity, mass, shear, rotary, .. } = span;
    let turned = if shear == 0.0 {
        k * k
    } else {
        let b = k * k * (rotary - shear * mass * rigidity);
        roots_of_both_signs(rotary, b, shear * mass * mass * squared)[spectrum]
    };
    let turn = turned / k;
    let amplitude = (0.5 * length * (mass + rotary * turn * turn)).sqrt().recip();
    // the rotation at a pinned end and the displacement at a guided one are positive
    let wave = if starts_pinned { [0.0, amplitude.copysign(turn), 0.0, 0.0] } else { [amplitude, 0.0, 0.0, 0.0] };
    (squared.sqrt(), Piece::Long { k, second: Second::Decaying(k), length, wave, turns: [turn, k] })
}

/// All sections rotating alike.
fn pure_shear(span: &Span) -> Wave {
    let &Span { length, shear, rotary, .. } = span;
    let amplitude = (rotary * length).sqrt().recip();
    let shape = Piece::Long {
        k: PI / length,
        second: Second::Bounded(0.0),
        length,
        wave: [0.0, 0.0, 0.0, amplitude],
        turns: [1.0, 1.0],
    };
    ((shear * rotary).sqrt().recip(), shape)
}

/// The first `wanted` elastic modes; `None` for other ends, on a foundation, and under a compression for which the beam buckles.
pub(crate) fn standing_waves(span: &Span, ends: [End; 2], wanted: usize) -> Option<Vec<Wave>> {
    use End::{Guided, Pinned};
    let shift = match ends {
        [Pinned, Pinned] | [Guided, Guided] => 0.0,
        [Pinned, Guided] | [Guided, Pinned] => 0.5,
        _ => return None,
    };
    let starts_pinned = ends[0] == Pinned;
    let of_number = |n: usize| {
        let k = (n as f64 - shift) * PI / span.length;
        (k, squared_frequencies(span, k))
    };
    if span.foundation != 0.0 || of_number(1).1[0] <= 0.0 {
        return None;
    }
    let numbers: Vec<(f64, [f64; 2])> = (1..=wanted).map(of_number).collect();
    let mut waves: Vec<Wave> =
        numbers.iter().map(|&(k, [squared, _])| wave(span, starts_pinned, k, squared, 0)).collect();
    let fastest = waves.last().map_or(0.0, |(omega, _)| *omega);
    if ends == [Pinned; 2] && span.shear * span.rotary > 0.0 {
        waves.push(pure_shear(span));
    }
    for (k, [_, squared]) in numbers {
        if squared.is_nan() || squared >= fastest * fastest {
            break;
        }
        waves.push(wave(span, starts_pinned, k, squared, 1));
    }
    waves.sort_by(|(omega, _), (other, _)| omega.total_cmp(other));
    waves.truncate(wanted);
    Some(waves)
}
