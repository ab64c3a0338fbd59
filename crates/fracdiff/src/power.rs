//! Powers `t^(order - 1)`, the kernels of the crate.

/// The kernel `t^(order - 1)`, with integer and half-integer orders free of `powf`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Power {
    Integer(i32),
    HalfInteger(i32),
    Real(f64),
}

impl Power {
    /// The function `t^exponent`.
    pub fn new(exponent: f64) -> Power {
        if exponent.abs() > 16.0 {
            Power::Real(exponent)
        } else if exponent == exponent.round() {
            Power::Integer(exponent as i32)
        } else if exponent - 0.5 == (exponent - 0.5).round() {
            Power::HalfInteger((exponent - 0.5) as i32)
        } else {
            Power::Real(exponent)
        }
    }

    #[inline]
    pub fn at(self, t: f64) -> f64 {
        match self {
            Power::Integer(0) => 1.0,
            Power::Integer(1) => t,
            Power::HalfInteger(0) => t.sqrt(),
            Power::HalfInteger(-1) => 1.0 / t.sqrt(),
            Power::Integer(n) => t.powi(n),
            Power::HalfInteger(n) => t.sqrt() * t.powi(n),
            Power::Real(e) => t.powf(e),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Power;

    #[test]
    fn agrees_with_powf() {
        for e in [-0.75, -0.5, 0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 2.5, 20.0] {
            for t in [1e-9, 0.3, 1.0, 7.0, 1e5_f64] {
                assert!((Power::new(e).at(t) / t.powf(e) - 1.0).abs() < 4e-15, "{t}^{e}");
            }
        }
    }
}
