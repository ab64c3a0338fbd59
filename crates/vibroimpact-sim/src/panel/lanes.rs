//! Real and complex numbers of [`LANES`] modes at a time.
//!
//! Every operation rounds as that on one number does, so that a mode has the same values in any lane.

use super::vector::LANES;
use num_complex::Complex64;
use std::ops::{Add, Mul, Neg, Sub};

/// One number for each mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lanes(pub [f64; LANES]);

/// One complex number for each mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ComplexLanes {
    pub re: Lanes,
    pub im: Lanes,
}

impl Lanes {
    pub const ZERO: Lanes = Lanes([0.0; LANES]);
    pub const ONE: Lanes = Lanes([1.0; LANES]);

    #[inline(always)]
    pub fn of(value: impl Fn(usize) -> f64) -> Lanes {
        let mut lanes = [0.0; LANES];
        for (l, lane) in lanes.iter_mut().enumerate() {
            *lane = value(l);
        }
        Lanes(lanes)
    }
}

macro_rules! lane_by_lane {
    ($($operation:ident $function:ident $sign:tt)*) => {$(
        impl $operation for Lanes {
            type Output = Lanes;

            #[inline(always)]
            fn $function(self, other: Lanes) -> Lanes {
                let (Lanes(a), Lanes(b)) = (self, other);
                let mut lanes = [0.0; LANES];
                for l in 0..LANES {
                    lanes[l] = a[l] $sign b[l];
                }
                Lanes(lanes)
            }
        }
    )*};
}
lane_by_lane!(Add add + Sub sub - Mul mul *);

impl Neg for Lanes {
    type Output = Lanes;

    #[inline(always)]
    fn neg(self) -> Lanes {
        Lanes(self.0.map(|value| -value))
    }
}

impl Mul<f64> for Lanes {
    type Output = Lanes;

    #[inline(always)]
    fn mul(self, factor: f64) -> Lanes {
        self * Lanes([factor; LANES])
    }
}

impl ComplexLanes {
    pub const ZERO: ComplexLanes = ComplexLanes { re: Lanes::ZERO, im: Lanes::ZERO };

    #[inline(always)]
    pub fn of(value: impl Fn(usize) -> Complex64) -> ComplexLanes {
        let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            let value = value(l);
            (re[l], im[l]) = (value.re, value.im);
        }
        ComplexLanes { re: Lanes(re), im: Lanes(im) }
    }

    #[inline(always)]
    pub fn set_lane(&mut self, l: usize, value: Complex64) {
        (self.re.0[l], self.im.0[l]) = (value.re, value.im);
    }

    #[inline(always)]
    pub fn of_lane(&self, l: usize) -> Complex64 {
        Complex64::new(self.re.0[l], self.im.0[l])
    }
}

impl Add for ComplexLanes {
    type Output = ComplexLanes;

    #[inline(always)]
    fn add(self, other: ComplexLanes) -> ComplexLanes {
        ComplexLanes { re: self.re + other.re, im: self.im + other.im }
    }
}

impl Sub for ComplexLanes {
    type Output = ComplexLanes;

    #[inline(always)]
    fn sub(self, other: ComplexLanes) -> ComplexLanes {
        ComplexLanes { re: self.re - other.re, im: self.im - other.im }
    }
}

impl Mul for ComplexLanes {
    type Output = ComplexLanes;

    #[inline(always)]
    fn mul(self, other: ComplexLanes) -> ComplexLanes {
        ComplexLanes { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}

impl Mul<Lanes> for ComplexLanes {
    type Output = ComplexLanes;

    #[inline(always)]
    fn mul(self, factor: Lanes) -> ComplexLanes {
        ComplexLanes { re: self.re * factor, im: self.im * factor }
    }
}

impl Mul<f64> for ComplexLanes {
    type Output = ComplexLanes;

    #[inline(always)]
    fn mul(self, factor: f64) -> ComplexLanes {
        ComplexLanes { re: self.re * factor, im: self.im * factor }
    }
}
