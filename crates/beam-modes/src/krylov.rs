//! Krylov's functions.

/// `[1/m!, 1/(m+4)!, 1/(m+8)!, ...]` for m = 0..4.
const TAYLOR: [[f64; 6]; 4] = {
    let mut table = [[0.0; 6]; 4];
    let (mut n, mut inverse_factorial) = (0, 1.0);
    while n < 24 {
        table[n % 4][n / 4] = inverse_factorial;
        n += 1;
        inverse_factorial /= n as f64;
    }
    table
};

/// `sum_i (y^4)^i / (4i+m)!` for m = 0..4: times `y^m`, these are Krylov's functions, `(cosh y + cos y)/2` and so on.
pub(crate) fn krylov(y: f64) -> [f64; 4] {
    let y4 = (y * y) * (y * y);
    TAYLOR.map(|row| row.iter().rev().fold(0.0, |sum, coefficient| sum * y4 + coefficient))
}
