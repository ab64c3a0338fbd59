//! Quantities of an impact that can be measured as one number.

use vibroimpact_sim::modal::{Derivatives, Solution, SubImpact};

/// A measured quantity; its name is that of the column of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Net restitution.
    Restitution,
    /// Velocity of the striker after the impact, positive away from the structure (m/s).
    StrikerVelocity,
    /// Duration of the first contact (s).
    FirstContact,
    /// Impulse of the first contact (N s).
    FirstImpulse,
    /// Largest force of the first contact (N).
    FirstPeakForce,
    /// Time from the first touch to the last separation (s).
    LastSeparation,
    /// Impulse of all contacts (N s).
    Impulse,
    /// Largest force of all contacts (N).
    PeakForce,
    /// Largest compression of all contacts (m).
    PeakCompression,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Quantity; 9] = [
        Quantity::Restitution,
        Quantity::StrikerVelocity,
        Quantity::FirstContact,
        Quantity::FirstImpulse,
        Quantity::FirstPeakForce,
        Quantity::LastSeparation,
        Quantity::Impulse,
        Quantity::PeakForce,
        Quantity::PeakCompression,
    ];

    /// The name of its column.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Restitution => "restitution",
            Quantity::StrikerVelocity => "striker_velocity_m_s",
            Quantity::FirstContact => "first_contact_s",
            Quantity::FirstImpulse => "first_impulse_n_s",
            Quantity::FirstPeakForce => "first_peak_force_n",
            Quantity::LastSeparation => "last_separation_s",
            Quantity::Impulse => "impulse_n_s",
            Quantity::PeakForce => "peak_force_n",
            Quantity::PeakCompression => "peak_compression_m",
        }
    }

    /// The quantity with this column.
    pub fn named(name: &str) -> Option<Quantity> {
        Quantity::ALL.into_iter().find(|quantity| quantity.name() == name)
    }

    /// The names of all columns, for messages.
    pub(super) fn names() -> String {
        Quantity::ALL.map(Quantity::name).join(", ")
    }

    /// Checks that a value is possible for this quantity.
    pub(super) fn allows(self, value: f64) -> Result<(), &'static str> {
        match self {
            Quantity::Restitution | Quantity::StrikerVelocity => Ok(()),
            _ if value > 0.0 => Ok(()),
            _ => Err("a finite number greater than 0"),
        }
    }

    /// Its value in a resolved impact; NaN if there is none.
    pub(super) fn of(self, solution: &Solution) -> f64 {
        let contacts = &solution.sub_impacts;
        let first = contacts.first();
        let largest = |of: fn(&SubImpact) -> f64| contacts.iter().map(of).fold(f64::NAN, f64::max);
        let value = match self {
            Quantity::Restitution => solution.restitution,
            Quantity::StrikerVelocity => solution.restitution.map(|_| solution.striker_velocity_m_s),
            Quantity::FirstContact => first.map(|contact| contact.end_s - contact.start_s),
            Quantity::FirstImpulse => first.map(|contact| contact.impulse_n_s),
            Quantity::FirstPeakForce => first.map(|contact| contact.peak_force_n),
            Quantity::LastSeparation => {
                first.filter(|_| solution.restitution.is_some()).map(|contact| solution.end_s - contact.start_s)
            }
            Quantity::Impulse => first.map(|_| contacts.iter().map(|contact| contact.impulse_n_s).sum()),
            Quantity::PeakForce => Some(largest(|contact| contact.peak_force_n)),
            Quantity::PeakCompression => Some(largest(|contact| contact.peak_compression_m)),
        };
        value.unwrap_or(f64::NAN)
    }

    /// Its derivative, from those of the impact; `None` if there is none.
    pub(super) fn change(self, solution: &Solution, change: &Derivatives) -> Option<f64> {
        let (contacts, changes) = (&solution.sub_impacts, &change.sub_impacts);
        let first = changes.first()?;
        // the derivative of the largest value is that of its contact
        let largest = |of: fn(&SubImpact) -> f64| {
            let place = (0..contacts.len()).max_by(|&a, &b| of(&contacts[a]).total_cmp(&of(&contacts[b])))?;
            changes.get(place)
        };
        Some(match self {
            Quantity::Restitution => change.restitution.value,
            Quantity::StrikerVelocity => change.striker_velocity_m_s.value,
            Quantity::FirstContact => first.end_s.value - first.start_s.value,
            Quantity::FirstImpulse => first.impulse_n_s.value,
            Quantity::FirstPeakForce => first.peak_force_n.value,
            Quantity::LastSeparation => change.end_s.value - first.start_s.value,
            Quantity::Impulse => changes.iter().map(|contact| contact.impulse_n_s.value).sum(),
            Quantity::PeakForce => largest(|contact| contact.peak_force_n)?.peak_force_n.value,
            Quantity::PeakCompression => largest(|contact| contact.peak_compression_m)?.peak_compression_m.value,
        })
    }
}
