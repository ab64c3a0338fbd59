//! Computes the chunks of a sweep on the threads of one machine.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::assembly::{Assembly, Order};
use super::definition::Sweep;
use super::error::SweepError;
use super::part::Part;
use super::row;
use super::status::{Sink, Status};

/// Interval between two writes of rows, whose work is lost by an interruption.
pub(super) const BETWEEN_WRITES: Duration = Duration::from_millis(200);
/// Interval between two reports of the progress, and between two checks of `stop`.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// The assembly and the signal that it has changed.
struct Desk {
    assembly: Mutex<Assembly>,
    changed: Condvar,
}

impl Desk {
    fn assembly(&self) -> MutexGuard<'_, Assembly> {
        // no thread panics while it holds the lock
        self.assembly.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Computes what is missing in the sink, a folder for example, of the chunks before `until`, and puts it there in order.
/// `threads` of 0 stands for as many as the machine has cores.
pub(super) fn compute(
    sweep: &Sweep,
    part: Part,
    until: u64,
    sink: &mut impl Sink,
    threads: usize,
    stop: &AtomicBool,
    tell: &mut dyn FnMut(Status),
) -> Result<(), SweepError> {
    let threads = if threads == 0 { thread::available_parallelism().map_or(1, usize::from) } else { threads };
    let first = part.chunks(sweep.chunks()).start;
    let begun = (first + sink.chunks())..(first + until);
    let desk = Desk { assembly: Mutex::new(Assembly::new(begun, threads)), changed: Condvar::new() };
    // an error of the writer also ends the workers
    let ended = AtomicBool::new(false);
    let give_up = || stop.load(Ordering::Relaxed) || ended.load(Ordering::Relaxed);
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(|| work(sweep, &desk, give_up))).collect();
        let written = write(sweep, part, sink, &desk, stop, tell);
        ended.store(true, Ordering::Relaxed);
        desk.changed.notify_all();
        for worker in workers {
            worker.join().unwrap_or_else(|panic| resume_unwind(panic));
        }
        written
    })
}

fn work(sweep: &Sweep, desk: &Desk, give_up: impl Fn() -> bool) {
    let mut kept = sweep.results().kept();
    while !give_up() {
        let order = desk.assembly().hand_out();
        match order {
            Order::Chunk(chunk) => {
                let Some(rows) = row::rows(sweep, chunk, &mut kept, &give_up) else { return };
                desk.assembly().take_in(chunk, rows);
                desk.changed.notify_all();
            }
            Order::Wait => {
                let assembly = desk.assembly();
                drop(desk.changed.wait_timeout(assembly, BETWEEN_LOOKS));
            }
            Order::Done => return,
        }
    }
}

fn write(
    sweep: &Sweep,
    part: Part,
    sink: &mut impl Sink,
    desk: &Desk,
    stop: &AtomicBool,
    tell: &mut dyn FnMut(Status),
) -> Result<(), SweepError> {
    let mut last = Instant::now();
    loop {
        let (complete, rows) = {
            let mut assembly = desk.assembly();
            if !assembly.is_complete() && !stop.load(Ordering::Relaxed) {
                assembly = desk.changed.wait_timeout(assembly, BETWEEN_LOOKS).unwrap_or_else(PoisonError::into_inner).0;
            }
            let complete = assembly.is_complete();
            let due = complete || stop.load(Ordering::Relaxed) || last.elapsed() >= BETWEEN_WRITES;
            (complete, due.then(|| assembly.take_ready()))
        };
        if let Some((chunks, rows)) = rows {
            last = Instant::now();
            if chunks > 0 {
                sink.append(chunks, &rows)?;
            }
        }
        let status = Status::of(sweep, part, sink);
        tell(status);
        if complete {
            return Ok(());
        }
        if stop.load(Ordering::Relaxed) {
            return Err(SweepError::Stopped { done: status.done, points: status.points });
        }
    }
}
