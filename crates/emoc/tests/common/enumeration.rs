//! A convex quadratic program by brute force: every set of active rows, accepted by the optimality conditions.

/// Minimises `sum h_i x_i^2 / 2` subject to `row . x >= bound`.
pub fn minimise(h: &[f64], rows: &[(Vec<f64>, f64)]) -> Option<Vec<f64>> {
    let mut chosen = Vec::new();
    choose(h, rows, 0, &mut chosen)
}

fn choose(h: &[f64], rows: &[(Vec<f64>, f64)], from: usize, chosen: &mut Vec<usize>) -> Option<Vec<f64>> {
    if let Some(x) = optimal(h, rows, chosen) {
        return Some(x);
    }
    if chosen.len() == h.len() {
        return None;
    }
    for next in from..rows.len() {
        chosen.push(next);
        let found = choose(h, rows, next + 1, chosen);
        chosen.pop();
        if found.is_some() {
            return found;
        }
    }
    None
}

/// The stationary point with the chosen rows as equations, if it satisfies all rows and no multiplier is negative.
fn optimal(h: &[f64], rows: &[(Vec<f64>, f64)], chosen: &[usize]) -> Option<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
    // x = H^-1 A^T lambda, A H^-1 A^T lambda = bound
    let n = chosen.len();
    let scaled: Vec<Vec<f64>> = chosen.iter().map(|&i| rows[i].0.iter().zip(h).map(|(a, h)| a / h).collect()).collect();
    let mut system: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            let row = &rows[chosen[i]];
            scaled.iter().map(|other| dot(&row.0, other)).chain([row.1]).collect()
        })
        .collect();
    for column in 0..n {
        let pivot = (column..n).max_by(|&a, &b| system[a][column].abs().total_cmp(&system[b][column].abs()))?;
        system.swap(column, pivot);
        let largest = system[column][..n].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if system[column][column].abs() <= 1e-12 * largest.max(1e-12) {
            return None;
        }
        for i in 0..n {
            if i != column {
                let factor = system[i][column] / system[column][column];
                for j in column..=n {
                    system[i][j] -= factor * system[column][j];
                }
            }
        }
    }
    let lambda: Vec<f64> = (0..n).map(|i| system[i][n] / system[i][i]).collect();
    let x: Vec<f64> = (0..h.len()).map(|j| (0..n).map(|i| lambda[i] * scaled[i][j]).sum()).collect();
    let feasible = rows.iter().all(|(row, bound)| dot(row, &x) >= bound - 1e-10);
    (feasible && lambda.iter().all(|l| *l >= -1e-10)).then_some(x)
}
