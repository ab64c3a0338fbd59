//! Messages during work whose progress is not known.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use super::voice::{is_quiet, note, seconds, tell};

/// Time before the first line.
const FIRST: Duration = Duration::from_secs(10);
/// Each pause is twice as long as the last, up to this.
const LONGEST: Duration = Duration::from_secs(300);

/// Does the work, and reports on the standard error from time to time that it continues.
pub fn watched<T>(name: &str, work: impl FnOnce() -> T) -> T {
    let report = |elapsed: Duration| {
        if !is_quiet() {
            tell(format_args!("{name}: {} s so far, still computing", elapsed.as_secs()));
        }
    };
    let begun = Instant::now();
    let result = watched_from(FIRST, report, work);
    note(|| format!("{name}: computed in {}", seconds(begun.elapsed())));
    result
}

fn watched_from<T>(first: Duration, report: impl Fn(Duration) + Send, work: impl FnOnce() -> T) -> T {
    let (done, waiting) = channel::<()>();
    let begun = Instant::now();
    thread::scope(|scope| {
        scope.spawn(move || {
            let mut silence = first;
            while waiting.recv_timeout(silence) == Err(RecvTimeoutError::Timeout) {
                report(begun.elapsed());
                silence = (2 * silence).min(LONGEST);
            }
        });
        let result = work();
        // ends the wait, and with it the thread
        drop(done);
        result
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn long_work_is_heard_of_and_short_work_is_not() {
        let heard = Mutex::new(Vec::new());
        let report = |elapsed| heard.lock().unwrap().push(elapsed);
        assert_eq!(watched_from(FIRST, report, || 7), 7);
        assert!(heard.lock().unwrap().is_empty());
        // the work lasts until three messages have been written
        let count = || heard.lock().unwrap().len();
        watched_from(Duration::from_millis(1), report, || {
            while count() < 3 {
                thread::yield_now();
            }
        });
        assert!(heard.lock().unwrap().windows(2).all(|pair| pair[0] < pair[1]));
    }
}
