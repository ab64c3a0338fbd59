//! Records of a run: intervals of contact, samples of the motion, a Poincare section.

use std::mem;
use std::sync::atomic::{AtomicBool, Ordering};

use contact_models::Law;
use vibroimpact_sim::assembly::{Assembly, ContactSample, Interval, Motion, Observer};

use super::spectrum::SpectrumSamples;
use super::steady::Moments;
use crate::export::Failure;

/// Least number of equal intervals of a history.
const HISTORY_INTERVALS: usize = 4096;
/// Largest number of additional samples in contact.
const MOST_IN_CONTACT: usize = 40_000;
/// Samples within a panel of contact.
const WITHIN: usize = 4;
/// Most panels of one stretch of contact. A stretch also begins where a contact closes.
const STRETCH: u64 = 16;
/// Most points of a section.
const MOST_SECTIONS: usize = 100_000;

/// Receives the intervals one after the other.
pub type Sink<'a> = &'a mut dyn FnMut(usize, &Interval) -> Result<(), Failure>;

/// All contacts at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Time (s).
    pub time_s: f64,
    /// The contacts, in the order of the assembly.
    pub contacts: Vec<ContactSample>,
}

/// The motion of a run, sampled.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Course {
    /// Samples in order of time: at equal distances, and more while contacts are closed. In a run with many contacts only every
    /// second, fourth, eighth, ... stretch of contact has these further samples, over the whole run.
    pub rows: Vec<Row>,
    /// For each row its stretch of contact; `None` if it is one of those at equal distances.
    stretches: Vec<Option<u64>>,
    /// Interval between these (s).
    pub step_s: f64,
    /// Once in each common period of the harmonic loads, or of the slowest one if they have none.
    pub section: Vec<Row>,
    /// This period (s).
    pub period_s: Option<f64>,
    /// The displacements at equal distances, for their spectrum.
    pub spectrum: SpectrumSamples,
    in_contact: usize,
    /// The stretch of contact, and the number of its panels so far; zero panels while no contact is closed.
    stretch: u64,
    panels: u64,
    /// The stretches whose number is a multiple of `2^skipped` have samples.
    skipped: u32,
}

impl Course {
    pub(super) fn new(assembly: &Assembly<Law>, end_s: f64, period_s: Option<f64>) -> Course {
        let longest_s = end_s / HISTORY_INTERVALS as f64;
        // a whole number of samples in each period of the loads, or of periods between samples, so that harmonics too fast for the
        // samples appear in the spectrum as other harmonics, and not as frequencies that the motion does not have
        let step_s = period_s.map_or(longest_s, |period_s| match period_s >= longest_s {
            true => period_s / (period_s / longest_s).ceil(),
            false => period_s * (longest_s / period_s).floor(),
        });
        Course { step_s, period_s, spectrum: SpectrumSamples::new(assembly, step_s), ..Course::default() }
    }

    fn add(&mut self, panel: &dyn Motion, contacts: usize) {
        let (start, end) = (panel.start_s(), panel.end_s());
        let row = |time_s: f64| Row { time_s, contacts: (0..contacts).map(|c| panel.contact(c, time_s)).collect() };
        let closed = (0..contacts).any(|c| panel.contact(c, 0.5 * (start + end)).closed);
        let mut times: Vec<(f64, Option<u64>)> =
            multiples(start, end, self.step_s).map(|time_s| (time_s, None)).collect();
        self.panels = if closed { self.panels + 1 } else { 0 };
        if closed {
            if self.panels % STRETCH == 1 {
                self.stretch += 1;
            }
            if self.in_contact >= MOST_IN_CONTACT {
                self.skip_every_second_stretch();
            }
            if self.has_samples(self.stretch) {
                self.in_contact += WITHIN;
                let within = (0..WITHIN).map(|i| start + (end - start) * i as f64 / WITHIN as f64);
                times.extend(within.map(|time_s| (time_s, Some(self.stretch))));
                times.sort_by(|a, b| a.0.total_cmp(&b.0));
                // where two samples coincide, the one at equal distances is first, and stays
                times.dedup_by_key(|(time_s, _)| *time_s);
            }
        }
        for (time_s, stretch) in times {
            if stretch.is_none() {
                self.spectrum.add(panel, time_s);
            }
            self.rows.push(row(time_s));
            self.stretches.push(stretch);
        }
        if let Some(period_s) = self.period_s
            && self.section.len() < MOST_SECTIONS
        {
            self.section.extend(multiples(start, end, period_s).map(row));
        }
    }

    fn has_samples(&self, stretch: u64) -> bool {
        stretch.trailing_zeros() >= self.skipped
    }

    /// Drops the samples of every second stretch that has some, so that memory is limited and the whole run is treated alike.
    fn skip_every_second_stretch(&mut self) {
        self.skipped += 1;
        let samples = mem::take(&mut self.rows).into_iter().zip(mem::take(&mut self.stretches));
        let kept = samples.filter(|(_, stretch)| stretch.is_none_or(|stretch| self.has_samples(stretch)));
        (self.rows, self.stretches) = kept.unzip();
        self.in_contact = self.stretches.iter().flatten().count();
    }
}

/// The multiples of a step in `[start, end)`. Their rounded values are compared with the ends, so that of two adjoining panels
/// exactly one has each multiple.
fn multiples(start: f64, end: f64, step: f64) -> impl Iterator<Item = f64> {
    let before = ((start / step).floor() - 1.0).max(0.0) as u64;
    (before..).map(move |i| i as f64 * step).skip_while(move |time| *time < start).take_while(move |time| *time < end)
}

/// Observes a run.
pub(super) struct Watch<'a> {
    /// Stored intervals, contact by contact.
    pub intervals: Vec<Vec<Interval>>,
    /// How many more there were.
    pub left_out: Vec<u64>,
    /// Number of intervals that may still be stored.
    room: usize,
    /// Receiver of all intervals.
    sink: Option<Sink<'a>>,
    /// Error of the receiver.
    pub fault: Option<Failure>,
    /// Samples of the motion, if they are requested.
    pub course: Option<Course>,
    /// The end of the motion, if the load has a period.
    pub moments: Option<Moments>,
    stop: &'a AtomicBool,
    tell: &'a mut dyn FnMut(f64),
    time_s: f64,
}

impl<'a> Watch<'a> {
    pub fn new(
        contacts: usize,
        room: usize,
        sink: Option<Sink<'a>>,
        course: Option<Course>,
        period_s: Option<f64>,
        stop: &'a AtomicBool,
        tell: &'a mut dyn FnMut(f64),
    ) -> Watch<'a> {
        let (intervals, left_out) = (vec![Vec::new(); contacts], vec![0; contacts]);
        let moments = period_s.map(Moments::new);
        Watch { intervals, left_out, room, sink, fault: None, course, moments, stop, tell, time_s: 0.0 }
    }
}

impl Observer for Watch<'_> {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        self.time_s = interval.end_s.unwrap_or(interval.start_s).max(self.time_s);
        if let Some(sink) = &mut self.sink
            && self.fault.is_none()
        {
            self.fault = sink(contact, interval).err();
        }
        if let Some(moments) = &mut self.moments {
            moments.end_interval();
        }
        if self.room > 0 {
            self.room -= 1;
            self.intervals[contact].push(*interval);
        } else {
            self.left_out[contact] += 1;
        }
    }

    fn panel(&mut self, panel: &dyn Motion) {
        self.time_s = panel.end_s();
        let contacts = self.intervals.len();
        if let Some(course) = &mut self.course {
            course.add(panel, contacts);
        }
        if let Some(moments) = &mut self.moments {
            moments.add(panel, contacts);
        }
    }

    fn wants_panels(&self) -> bool {
        self.course.is_some() || self.moments.is_some()
    }

    fn wants_energy(&self) -> bool {
        true
    }

    fn interrupts(&mut self) -> bool {
        (self.tell)(self.time_s);
        self.fault.is_some() || self.stop.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::multiples;

    #[test]
    fn every_multiple_of_the_step_is_on_exactly_one_panel() {
        // 6 * 0.1 is more than 0.6, and 0.6000000000000001 / 0.1 is more than 6
        for step in [0.1, 0.3, 0.7] {
            let all: Vec<f64> = (0..100).map(|i| f64::from(i) * step).collect();
            for nudge in [f64::next_down, |end| end, f64::next_up] {
                let ends: Vec<f64> = all.iter().step_by(3).map(|time| nudge(*time).max(0.0)).collect();
                let found = ends.windows(2).flat_map(|ends| multiples(ends[0], ends[1], step));
                let first = all.iter().position(|time| *time >= ends[0]).unwrap();
                let expected = all[first..].iter().copied().filter(|time| *time < ends[ends.len() - 1]);
                assert_eq!(found.collect::<Vec<_>>(), expected.collect::<Vec<_>>(), "{step}");
            }
        }
    }
}
