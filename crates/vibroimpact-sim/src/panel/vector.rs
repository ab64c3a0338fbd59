//! Loops over the modes, with the widest vector instructions of the machine.
//!
//! A sum consists of [`LANES`] partial sums on every machine, so that all results have the same bits.

use pulp::Arch;
use std::sync::LazyLock;

/// Partial sums of a sum over modes, and modes taken at a time.
pub(crate) const LANES: usize = 4;

static ARCH: LazyLock<Arch> = LazyLock::new(Arch::new);

/// Compiles `work`, and what is inlined in it, for each kind of vector unit, and runs the one for this machine.
#[inline]
pub(crate) fn vectorized<R>(work: impl FnOnce() -> R) -> R {
    ARCH.dispatch(work)
}

/// The total of the partial sums.
#[inline(always)]
pub(crate) fn sum_of_lanes(lanes: [f64; LANES]) -> f64 {
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3])
}

/// `sum term(values of mode k)`, of rows of equal length.
#[inline(always)]
pub(crate) fn sum_over<const ROWS: usize, const OUT: usize>(
    rows: [&[f64]; ROWS],
    term: impl Fn([f64; ROWS]) -> [f64; OUT],
) -> [f64; OUT] {
    let n = rows.iter().map(|row| row.len()).min().unwrap_or(0);
    let chunks = rows.map(|row| row[..n].as_chunks::<LANES>());
    let mut sums = [[0.0; LANES]; OUT];
    for i in 0..n / LANES {
        let block = chunks.map(|(whole, _)| whole[i]);
        for lane in 0..LANES {
            let terms = term(block.map(|row| row[lane]));
            for out in 0..OUT {
                sums[out][lane] += terms[out];
            }
        }
    }
    let mut total = sums.map(sum_of_lanes);
    for i in 0..n % LANES {
        let terms = term(chunks.map(|(_, rest)| rest[i]));
        for out in 0..OUT {
            total[out] += terms[out];
        }
    }
    total
}

/// Replaces two values of each mode by others, which depend on them and on those of further rows of equal length.
#[inline(always)]
pub(crate) fn change_each<const ROWS: usize>(
    [one, two]: [&mut [f64]; 2],
    rows: [&[f64]; ROWS],
    change: impl Fn([f64; 2], [f64; ROWS]) -> [f64; 2],
) {
    let n = rows.iter().map(|row| row.len()).fold(one.len().min(two.len()), usize::min);
    let (ones, rest_of_one) = one[..n].as_chunks_mut::<LANES>();
    let (twos, rest_of_two) = two[..n].as_chunks_mut::<LANES>();
    let chunks = rows.map(|row| row[..n].as_chunks::<LANES>());
    for i in 0..n / LANES {
        let block = chunks.map(|(whole, _)| whole[i]);
        let (mut a, mut b) = (ones[i], twos[i]);
        for lane in 0..LANES {
            [a[lane], b[lane]] = change([a[lane], b[lane]], block.map(|row| row[lane]));
        }
        (ones[i], twos[i]) = (a, b);
    }
    for i in 0..n % LANES {
        [rest_of_one[i], rest_of_two[i]] = change([rest_of_one[i], rest_of_two[i]], chunks.map(|(_, rest)| rest[i]));
    }
}
