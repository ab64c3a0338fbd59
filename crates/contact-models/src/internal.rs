//! The internal variables of a law.

/// Values of a law's internal variables: numbers that determine the force together with compression and rate. They change only
/// where a branch begins. A law has up to [`Internal::MOST`] of them, and only the law knows their meaning. Within the law they
/// are an array, or a type of its own with conversions in both directions:
///
/// ```
/// use contact_models::Internal;
///
/// struct Hardened {
///     indentation_m: f64,
///     back_force_n: f64,
/// }
///
/// impl From<Hardened> for Internal {
///     fn from(state: Hardened) -> Internal {
///         [state.indentation_m, state.back_force_n].into()
///     }
/// }
///
/// impl From<Internal> for Hardened {
///     fn from(internal: Internal) -> Hardened {
///         let [indentation_m, back_force_n] = internal.into();
///         Hardened { indentation_m, back_force_n }
///     }
/// }
///
/// let kept = Internal::from(Hardened { indentation_m: 1e-6, back_force_n: 20.0 });
/// assert_eq!(Hardened::from(kept).back_force_n, 20.0);
/// ```
///
/// Numbers that a law does not use are zero. For derivatives of an impact a variable is shifted by a small fraction of its
/// size, or of one if it is zero.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Internal([f64; Internal::MOST]);

impl Internal {
    /// Largest number of internal variables.
    pub const MOST: usize = 6;
    /// For a law without internal variables.
    pub const NONE: Internal = Internal([0.0; Internal::MOST]);
}

impl<const N: usize> From<[f64; N]> for Internal {
    fn from(values: [f64; N]) -> Internal {
        const { assert!(N <= Internal::MOST, "more internal variables than the maximum") };
        let mut internal = Internal::NONE;
        internal.0[..N].copy_from_slice(&values);
        internal
    }
}

/// The first `N` of them.
impl<const N: usize> From<Internal> for [f64; N] {
    fn from(internal: Internal) -> [f64; N] {
        const { assert!(N <= Internal::MOST, "more internal variables than the maximum") };
        std::array::from_fn(|i| internal.0[i])
    }
}
