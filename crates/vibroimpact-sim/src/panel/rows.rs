//! A table of a few rows, one value for each mode, in one piece of memory.

use super::lanes::Lanes;

/// `R` rows of the same length.
#[derive(Default)]
pub(crate) struct Rows<const R: usize> {
    values: Vec<f64>,
    length: usize,
}

impl<const R: usize> Rows<R> {
    /// Rows of zeros.
    pub fn new(length: usize) -> Rows<R> {
        Rows { values: vec![0.0; R * length], length }
    }

    /// Sets the `k`-th value of each row.
    pub fn set(&mut self, k: usize, values: [f64; R]) {
        for (row, value) in values.into_iter().enumerate() {
            self.values[row * self.length + k] = value;
        }
    }

    /// Sets `count` values of each row from the `first` on.
    #[inline(always)]
    pub fn set_lanes(&mut self, first: usize, count: usize, values: &[Lanes; R]) {
        for (row, Lanes(values)) in values.iter().enumerate() {
            self.values[row * self.length + first..][..count].copy_from_slice(&values[..count]);
        }
    }

    /// The values of all rows at `k`.
    #[inline(always)]
    pub fn at(&self, k: usize) -> [f64; R] {
        let mut values = [0.0; R];
        for (row, value) in values.iter_mut().enumerate() {
            *value = self.values[row * self.length + k];
        }
        values
    }

    /// A part of a row from the value `first` on.
    #[inline(always)]
    fn row(&self, row: usize, first: usize, count: usize) -> &[f64] {
        &self.values[row * self.length + first..][..count]
    }
}

/// The rows are listed one by one, because an array made by a closure is not inlined where the vector unit is chosen.
macro_rules! parts {
    ($count:literal: $($row:literal)*) => {
        impl Rows<$count> {
            /// A part of all rows from the value `first` on.
            #[inline(always)]
            pub fn part(&self, first: usize, count: usize) -> [&[f64]; $count] {
                [$(self.row($row, first, count)),*]
            }
        }
    };
}
parts!(4: 0 1 2 3);
parts!(8: 0 1 2 3 4 5 6 7);
