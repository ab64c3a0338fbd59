//! The two floating-point types.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// `f64` or `f32`: the closed form needs only the four operations and comparison.
pub trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + sealed::Sealed
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// The largest finite number.
    const MAX: Self;
    /// A count as a number.
    fn from_count(count: usize) -> Self;
    /// The same value in double precision, for messages.
    fn to_f64(self) -> f64;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

macro_rules! real {
    ($t:ident) => {
        impl Real for $t {
            const ZERO: $t = 0.0;
            const ONE: $t = 1.0;
            const MAX: $t = $t::MAX;
            #[inline]
            fn from_count(count: usize) -> $t {
                count as $t
            }
            #[inline]
            fn to_f64(self) -> f64 {
                self.into()
            }
        }
    };
}

real!(f32);
real!(f64);
