//! The names of a fixed set of values.

/// Gives an enum without data its names: `as_str`, [`Display`](core::fmt::Display) and [`FromStr`](core::str::FromStr), from
/// one list. A text that is none of them is an error of the named field. It needs the feature `alloc`.
///
/// ```
/// #[derive(Debug, Clone, Copy, PartialEq)]
/// enum End {
///     Clamped,
///     Free,
/// }
///
/// invalid_input::names!(End, "end", { Clamped: "clamped", Free: "free" });
///
/// assert_eq!(End::Free.to_string(), "free");
/// assert_eq!("clamped".parse(), Ok(End::Clamped));
/// let fault = "glued".parse::<End>().unwrap_err();
/// assert_eq!(fault.to_string(), "end = glued is not allowed; it must be one of clamped, free");
/// ```
#[macro_export]
macro_rules! names {
    ($kind:ident, $field:literal, { $first:ident: $first_name:literal $(, $other:ident: $name:literal)* $(,)? }) => {
        impl $kind {
            /// The name in messages and files.
            pub const fn as_str(self) -> &'static str {
                match self {
                    $kind::$first => $first_name,
                    $($kind::$other => $name,)*
                }
            }
        }

        impl ::core::fmt::Display for $kind {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                f.pad(self.as_str())
            }
        }

        impl ::core::str::FromStr for $kind {
            type Err = $crate::InvalidInput;

            fn from_str(name: &str) -> ::core::result::Result<Self, $crate::InvalidInput> {
                match name {
                    $first_name => Ok($kind::$first),
                    $($name => Ok($kind::$other),)*
                    _ => Err($crate::InvalidInput::new($field, name, concat!("one of ", $first_name $(, ", ", $name)*))),
                }
            }
        }
    };
}
