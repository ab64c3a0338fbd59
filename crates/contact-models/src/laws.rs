//! Every law behind one type.

use crate::{After, Boundary, Branch, ContactLaw, Force, Memory};

use crate::range::require_positive;
use crate::{
    Felt, Flores, Hertz, HuntCrossley, Hysteretic, KelvinVoigt, LankaraniNikravesh, LinearSpring, Power, Thornton,
    Viscous,
};
use invalid_input::InvalidInput;
use std::fmt;

/// Writes the enum, its name table and its dispatch from one list of laws.
macro_rules! laws {
    ($($(#[$doc:meta])* $variant:ident = $name:literal,)*) => {
        /// Every law of the crate behind one type, for scenes that choose their law at run time.
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(tag = "law"))]
        #[non_exhaustive]
        pub enum Law {
            $(
                $(#[$doc])*
                #[cfg_attr(feature = "serde", serde(rename = $name))]
                $variant($variant),
            )*
        }

        $(impl From<$variant> for Law {
            fn from(law: $variant) -> Law {
                Law::$variant(law)
            }
        })*

        /// Evaluates the same expression for any of the laws.
        macro_rules! each {
            ($law:expr, $inner:ident => $value:expr) => {
                match $law { $(Law::$variant($inner) => $value,)* }
            };
        }

        impl Law {
            /// The law's name in scene files and tables.
            pub fn name(&self) -> &'static str {
                match self { $(Law::$variant(_) => $name,)* }
            }
        }
    };
}

laws! {
    /// Elastic contact of curved bodies.
    Hertz = "hertz",
    /// The thesis's viscous contact dissipation.
    Viscous = "viscous",
    /// The thesis's rate-independent contact hysteresis.
    Hysteretic = "hysteretic",
    /// The linear spring.
    LinearSpring = "linear",
    /// A power of the compression.
    Power = "power",
    /// Spring and dashpot in parallel.
    KelvinVoigt = "kelvin-voigt",
    /// Hunt and Crossley's damped power law.
    HuntCrossley = "hunt-crossley",
    /// Lankarani and Nikravesh's law.
    LankaraniNikravesh = "lankarani-nikravesh",
    /// The law of Flores, Machado, Silva and Martins.
    Flores = "flores",
    /// The felt of piano hammers.
    Felt = "felt",
    /// Thornton's elastic, perfectly plastic contact.
    Thornton = "thornton",
}

impl Law {
    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// As for the `new` of the law.
    pub fn validated(self) -> Result<Law, InvalidInput> {
        each!(self, law => law.validated().map(Law::from))
    }

    /// Whether a complete contact returns all work that compresses it, whatever the parameters.
    pub fn conserves_energy(&self) -> bool {
        matches!(self, Law::Hertz(_) | Law::LinearSpring(_) | Law::Power(_))
    }

    /// Rebound speed over approach speed of a rigid striker at an immovable wall covered by this law (the thesis's `N = 0`), to
    /// rounding from closed or implicit relations; for felt by integration, to about 1e-12.
    ///
    /// # Errors
    /// A mass or speed that is not positive.
    pub fn wall_restitution(&self, mass_kg: f64, speed_m_s: f64) -> Result<f64, InvalidInput> {
        require_positive("mass_kg", mass_kg)?;
        require_positive("speed_m_s", speed_m_s)?;
        Ok(each!(self, law => law.wall_restitution(mass_kg, speed_m_s)))
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl ContactLaw for Law {
    fn touch(&self, memory: &Memory, approach_speed_m_s: f64) -> Branch {
        each!(self, law => law.touch(memory, approach_speed_m_s))
    }

    fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
        each!(self, law => law.force(branch, compression_m, rate_m_s))
    }

    fn forces(&self, branch: &Branch, compressions_m: &[f64], rates_m_s: &[f64], forces: &mut [Force]) {
        each!(self, law => law.forces(branch, compressions_m, rates_m_s, forces));
    }

    fn stored_energy_j(&self, branch: &Branch, compression_m: f64) -> f64 {
        each!(self, law => law.stored_energy_j(branch, compression_m))
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        each!(self, law => law.boundary(branch, which))
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, rate_m_s: f64) -> After {
        each!(self, law => law.cross(branch, which, compression_m, rate_m_s))
    }
}
