//! The simplex method of Nelder and Mead (1965) for objectives with kinks.
//!
//! It is implemented here because it is short and the available ones do not fit: `argmin`'s has no restart and depends on ten
//! further packages, and the COBYLA crates are machine translations of C full of `unsafe`. The coefficients depend on the
//! dimension as proposed by Gao and Han (Comput. Optim. Appl. 51:259, 2012); restarts with a new simplex prevent the collapse
//! for which the method is known.

/// Where the simplex ended.
pub(crate) struct Found {
    pub(crate) u: Vec<f64>,
    pub(crate) value: f64,
    pub(crate) converged: bool,
}

type Vertex = (Vec<f64>, f64);

/// Minimises `f` from `start` with first steps `steps`, to the tolerance times the coordinates, or times their `units` if these are larger.
/// The search avoids infinite values of `f`.
pub(crate) fn minimise(
    f: &mut dyn FnMut(&[f64]) -> f64,
    start: &[f64],
    steps: &[f64],
    units: &[f64],
    tolerance: f64,
    max_evaluations: usize,
) -> Found {
    let mut left = max_evaluations;
    let mut best = (start.to_vec(), f(start));
    let mut shrink = 1.0;
    loop {
        let before = best.1;
        let converged;
        (best, converged) = run(f, best, (steps, units), shrink, tolerance, &mut left);
        let gained = before - best.1 > tolerance.sqrt() * before.abs();
        if !converged || !gained {
            return Found { u: best.0, value: best.1, converged };
        }
        shrink *= 0.25;
    }
}

fn run(
    f: &mut dyn FnMut(&[f64]) -> f64,
    first: Vertex,
    (steps, units): (&[f64], &[f64]),
    shrink: f64,
    tolerance: f64,
    left: &mut usize,
) -> (Vertex, bool) {
    let n = steps.len();
    let dimension = n as f64;
    // Reflection is 1; expansion, contraction and shrinkage.
    let expansion = 1.0 + 2.0 / dimension;
    let contraction = 0.75 - 0.5 / dimension;
    let shrinkage = if n > 1 { 1.0 - 1.0 / dimension } else { 0.5 };
    let mut vertices = vec![first];
    for j in 0..n {
        let mut u = vertices[0].0.clone();
        u[j] += shrink * steps[j];
        let value = f(&u);
        vertices.push((u, value));
    }
    *left = left.saturating_sub(n);
    while *left > 0 {
        vertices.sort_by(|a, b| a.1.total_cmp(&b.1));
        if is_small(&vertices, units, tolerance) {
            return (vertices.swap_remove(0), true);
        }
        let worst = vertices[n].1;
        let centre: Vec<f64> =
            (0..n).map(|j| vertices[..n].iter().map(|vertex| vertex.0[j]).sum::<f64>() / dimension).collect();
        let away = |factor: f64| -> Vec<f64> {
            centre.iter().zip(&vertices[n].0).map(|(c, w)| c + factor * (c - w)).collect()
        };
        let mut tried = |u: Vec<f64>| {
            *left = left.saturating_sub(1);
            let value = f(&u);
            (u, value)
        };
        let reflected = tried(away(1.0));
        let accepted = if reflected.1 < vertices[0].1 {
            let expanded = tried(away(expansion));
            Some(if expanded.1 < reflected.1 { expanded } else { reflected })
        } else if reflected.1 < vertices[n - 1].1 {
            Some(reflected)
        } else {
            let outside = reflected.1 < worst;
            let contracted = tried(away(if outside { contraction } else { -contraction }));
            (contracted.1 < reflected.1.min(worst)).then_some(contracted)
        };
        match accepted {
            Some(vertex) => vertices[n] = vertex,
            None => {
                let best = vertices[0].0.clone();
                for vertex in &mut vertices[1..] {
                    for (x, b) in vertex.0.iter_mut().zip(&best) {
                        *x = b + shrinkage * (*x - b);
                    }
                    vertex.1 = f(&vertex.0);
                }
                *left = left.saturating_sub(n);
            }
        }
    }
    vertices.sort_by(|a, b| a.1.total_cmp(&b.1));
    (vertices.swap_remove(0), false)
}

/// Whether all vertices agree: in position to `tolerance`, or in position to its square root and in value to `tolerance` (where values
/// are flat to rounding).
/// A search that ends at a kink meets the first condition, one at a smooth minimum either.
fn is_small(vertices: &[Vertex], units: &[f64], tolerance: f64) -> bool {
    let (best, worst) = (&vertices[0], &vertices[vertices.len() - 1]);
    let place = vertices.iter().flat_map(|vertex| vertex.0.iter().zip(&best.0).zip(units));
    let extent = place.fold(0.0, |m: f64, ((x, b), unit)| m.max((x - b).abs() / b.abs().max(*unit)));
    extent <= tolerance || (extent <= tolerance.sqrt() && worst.1 - best.1 <= tolerance * best.1.abs())
}
