//! Values of a solution between the ends of its steps, by local polynomials in `t` or a panel's own polynomial in `x`.

use crate::quadrature::Interpolation;

#[derive(Debug, Clone)]
pub(crate) struct Dense {
    unknowns: usize,
    times: Vec<f64>,
    values: Vec<f64>,
    kind: Kind,
}

#[derive(Debug, Clone)]
enum Kind {
    /// Lagrange interpolation of this degree on neighbouring grid points of one segment.
    Grid { degree: usize, segment_starts: Vec<usize> },
    /// One polynomial per panel.
    Panels { interpolation: Interpolation, panels: Vec<PanelValues>, panel_of_time: Vec<usize> },
}

/// Nodal values of the solution on a panel of the variable `x = (t - origin)^(1/mapping)`.
#[derive(Debug, Clone)]
pub(crate) struct PanelValues {
    pub origin: f64,
    pub mapping: u32,
    pub x: [f64; 2],
    /// `nodes x unknowns`.
    pub y: Vec<f64>,
}

impl Dense {
    pub fn grid(unknowns: usize, degree: usize) -> Dense {
        let kind = Kind::Grid { degree, segment_starts: Vec::new() };
        Dense { unknowns, times: Vec::new(), values: Vec::new(), kind }
    }

    pub fn panels(unknowns: usize, interpolation: Interpolation) -> Dense {
        let kind = Kind::Panels { interpolation, panels: Vec::new(), panel_of_time: Vec::new() };
        Dense { unknowns, times: Vec::new(), values: Vec::new(), kind }
    }

    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    pub fn times(&self) -> &[f64] {
        &self.times
    }

    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Starts a segment of a grid; the next point pushed is its first.
    pub fn begin_segment(&mut self) {
        if let Kind::Grid { segment_starts, .. } = &mut self.kind {
            segment_starts.push(self.times.len());
        }
    }

    pub fn push(&mut self, t: f64, y: &[f64]) {
        self.times.push(t);
        self.values.extend_from_slice(y);
    }

    /// Appends a panel from `t[0]` to `t[1]`; the first of a segment includes the value at the start.
    pub fn push_panel(&mut self, t: [f64; 2], start: Option<&[f64]>, panel: PanelValues) {
        let Kind::Panels { interpolation, panels, panel_of_time } = &mut self.kind else { return };
        if let Some(start) = start {
            panel_of_time.push(panels.len());
            self.times.push(t[0]);
            self.values.extend_from_slice(start);
        }
        let mut basis = vec![0.0; interpolation.nodes.len()];
        interpolation.basis(1.0, &mut basis);
        panel_of_time.push(panels.len());
        self.times.push(t[1]);
        let end = self.values.len();
        self.values.resize(end + self.unknowns, 0.0);
        combine(&basis, &panel.y, &mut self.values[end..]);
        panels.push(panel);
    }

    /// Truncates the solution at `t`, inside the last step or panel.
    pub fn truncate(&mut self, t: f64) {
        let mut y = vec![0.0; self.unknowns];
        if self.eval(t, &mut y) {
            self.times.pop();
            self.values.truncate(self.times.len() * self.unknowns);
            self.push(t, &y);
        }
    }

    /// Fills `out` with the value at `t`; false if `t` is outside the solution.
    pub fn eval(&self, t: f64, out: &mut [f64]) -> bool {
        let (Some(&first), Some(&last)) = (self.times.first(), self.times.last()) else { return false };
        if !(t >= first && t <= last) {
            return false;
        }
        // The first point at or after t; at a break, the one that ends the earlier segment.
        let right = self.times.partition_point(|&s| s < t);
        if self.times[right] == t {
            out.copy_from_slice(&self.values[right * self.unknowns..(right + 1) * self.unknowns]);
            return true;
        }
        match &self.kind {
            Kind::Grid { degree, segment_starts } => {
                let which = segment_starts.partition_point(|&s| s < right) - 1;
                let low = segment_starts[which];
                let high = segment_starts.get(which + 1).copied().unwrap_or(self.times.len());
                let count = (degree + 1).min(high - low);
                let start = right.saturating_sub(count.div_ceil(2)).clamp(low, high - count);
                self.lagrange(start..start + count, t, out);
            }
            Kind::Panels { interpolation, panels, panel_of_time } => {
                let panel = &panels[panel_of_time[right]];
                let power = 1.0 / f64::from(panel.mapping);
                let tau = (t - panel.origin).max(0.0);
                let x = match panel.mapping {
                    1 => tau,
                    2 => tau.sqrt(),
                    _ => tau.powf(power),
                };
                let mut basis = vec![0.0; interpolation.nodes.len()];
                interpolation.basis((x - panel.x[0]) / (panel.x[1] - panel.x[0]), &mut basis);
                combine(&basis, &panel.y, out);
            }
        }
        true
    }

    fn lagrange(&self, points: std::ops::Range<usize>, t: f64, out: &mut [f64]) {
        out.fill(0.0);
        for i in points.clone() {
            let basis: f64 = points
                .clone()
                .filter(|&j| j != i)
                .map(|j| (t - self.times[j]) / (self.times[i] - self.times[j]))
                .product();
            for (c, v) in out.iter_mut().enumerate() {
                *v += basis * self.values[i * self.unknowns + c];
            }
        }
    }
}

/// `out = sum over j of basis_j * row_j`.
fn combine(basis: &[f64], rows: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    for (b, row) in basis.iter().zip(rows.chunks_exact(out.len())) {
        for (v, y) in out.iter_mut().zip(row) {
            *v += b * y;
        }
    }
}
