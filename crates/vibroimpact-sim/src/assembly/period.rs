//! The common period of harmonic loads.

use super::problem::{Force, Load};
use invalid_input::InvalidInput;
use std::f64::consts::TAU;

/// Largest deviation of a load from its repetition after the common period: relative to its frequency, and in its periods.
const COMMENSURATE: f64 = 1e-9;
const WHOLE: f64 = 1e-8;
/// Largest number of periods of the slowest load in the common period.
const MOST_CYCLES: u32 = 1000;

/// The shortest time that is a whole number of periods of every harmonic load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommonPeriod {
    /// This time (s).
    pub period_s: f64,
    /// Periods of the slowest load in it.
    pub cycles: u32,
}

impl CommonPeriod {
    /// The common period of the harmonic ones among these loads.
    ///
    /// # Errors
    /// If no load is harmonic, or if the common period has more than 1000 periods of the slowest load.
    pub fn of(loads: &[Load]) -> Result<CommonPeriod, InvalidInput> {
        let harmonic = || {
            loads.iter().enumerate().filter_map(|(i, load)| match load.force {
                Force::Harmonic { omega_rad_s, .. } => Some((i, omega_rad_s)),
                _ => None,
            })
        };
        let slowest = harmonic().map(|(_, omega)| omega).fold(f64::INFINITY, f64::min);
        InvalidInput::unless(
            slowest.is_finite(),
            "loads",
            "no harmonic load",
            "a list with at least one harmonic load",
        )?;
        let mut cycles = 1;
        for (i, omega) in harmonic() {
            let repeats = |cycles: &u32| {
                let turns = omega / slowest * f64::from(*cycles);
                (turns - turns.round()).abs() <= WHOLE.min(COMMENSURATE * turns)
            };
            // the multiples of the common period of the loads before this one
            cycles = (cycles..=MOST_CYCLES).step_by(cycles as usize).find(repeats).ok_or_else(|| {
                let allowed = format!(
                    "a frequency that has a common period with the other loads, of at most {MOST_CYCLES} periods of the slowest"
                );
                InvalidInput::new("omega_rad_s", omega, allowed).within("force").at(i).within("loads")
            })?;
        }
        Ok(CommonPeriod { period_s: TAU * f64::from(cycles) / slowest, cycles })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn period_of(frequencies_hz: &[f64]) -> Result<CommonPeriod, InvalidInput> {
        let load = |frequency_hz: &f64| {
            let force = Force::Harmonic { force_n: 1.0, omega_rad_s: TAU * frequency_hz, phase_rad: 0.0 };
            Load { body: 0, shape: vec![1.0], force }
        };
        let constant = Load { body: 0, shape: vec![1.0], force: Force::Constant { force_n: 2.0 } };
        let loads: Vec<Load> = frequencies_hz.iter().map(load).chain([constant]).collect();
        CommonPeriod::of(&loads)
    }

    #[test]
    fn frequencies_in_ratios_of_whole_numbers_have_a_common_period() {
        for (frequencies_hz, period_s, cycles) in [
            (vec![40.0], 0.025, 1),
            (vec![1.0, 1.5], 2.0, 2),
            (vec![1.5, 1.0], 2.0, 2),
            (vec![1.0, 1.5, 4.0 / 3.0], 6.0, 6),
            (vec![2.0, 10.0, 6.0], 0.5, 1),
            (vec![50.0, 50.1], 10.0, 500),
            (vec![1.0, 100_000.5], 2.0, 2),
        ] {
            let found = period_of(&frequencies_hz).unwrap();
            assert!((found.period_s / period_s - 1.0).abs() < 1e-12, "{frequencies_hz:?}: {found:?}");
            assert_eq!(found.cycles, cycles, "{frequencies_hz:?}");
        }
    }

    #[test]
    fn an_error_names_the_load_without_a_common_period() {
        for (frequencies_hz, wrong) in [
            (vec![1.0, 2f64.sqrt()], 1),
            (vec![1.0, 1.5, 1.0 + 1e-4], 2),
            // after 81 s it is off by 8e-7 of a period
            (vec![1.0, 27.12345678], 1),
            (vec![1.0, 1e7 + 0.314_159_2], 1),
        ] {
            let fault = period_of(&frequencies_hz).unwrap_err();
            assert_eq!(fault.field.to_string(), format!("loads[{wrong}].force.omega_rad_s"), "{fault}");
        }
        assert_eq!(period_of(&[]).unwrap_err().field.to_string(), "loads");
    }
}
