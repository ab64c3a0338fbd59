//! The method of thesis A.1 as it is used there: an ordinary differential equation with the matrices A, B and c and the
//! regularisation eps, compared with the known solution.
//!
//! Eq. A.2 is printed with the right-hand side `c y'`. The equation to be solved, `D^(3/2) y = -Gamma(3/2) f`, is of order `1 +
//! 1/2`, so that by Eq. A.1 (n = 2) the right-hand side is `c y''`, which is used here.

use fracdiff::{DasChatterjee, test_problems};
use nalgebra::{DMatrix, DVector};

const N: usize = 50;
const EPS: f64 = 1e-8;

#[test]
fn the_regularised_equation_reproduces_the_linear_beam() {
    let recipe = DasChatterjee::new(0.5, N, -2.4, 1.2).unwrap();
    let gamma = libm::tgamma(1.5);
    // States: a (N values), y, v = y', z, w = z'. Contact force f = y - z, the linear analogue.
    let (y, v, z, w) = (N, N + 1, N + 2, N + 3);
    let mut mass = DMatrix::zeros(N + 4, N + 4);
    let mut rate = DMatrix::zeros(N + 4, N + 4);
    for i in 0..N {
        for j in 0..N {
            // A a' - c v' = -B a
            mass[(i, j)] = recipe.a[i * N + j];
            rate[(i, j)] = -recipe.b[i * N + j];
        }
        mass[(i, v)] = -recipe.c[i];
        // eps v' = -c^T a - Gamma(3/2) f
        rate[(v, i)] = -recipe.c[i];
    }
    mass[(v, v)] = EPS;
    rate[(v, y)] = -gamma;
    rate[(v, z)] = gamma;
    mass[(y, y)] = 1.0;
    rate[(y, v)] = 1.0;
    mass[(z, z)] = 1.0;
    rate[(z, w)] = 1.0;
    mass[(w, w)] = 1.0;
    rate[(w, y)] = 1.0;
    rate[(w, z)] = -1.0;

    // BDF2 on equal steps, started by one step of the implicit Euler rule.
    let steps = 2000;
    let h = 2.0 / steps as f64;
    let mut before = DVector::zeros(N + 4);
    before[w] = -1.0;
    let mut now = (&mass - h * &rate).lu().solve(&(&mass * &before)).unwrap();
    let bdf2 = (1.5 * &mass - h * &rate).lu();
    let mut compression = vec![0.0, now[y] - now[z]];
    for _ in 2..=steps {
        let next = bdf2.solve(&(&mass * (2.0 * &now - 0.5 * &before))).unwrap();
        (before, now) = (now, next);
        compression.push(now[y] - now[z]);
    }
    for (t, exact) in test_problems::linear_beam().reference.into_iter().filter(|r| r.0 <= 2.0) {
        let error = (compression[(t / h).round() as usize] - exact).abs();
        println!("{t}: {error:e}");
        assert!(error < 1e-4, "{t}: {error:e}");
    }
}
