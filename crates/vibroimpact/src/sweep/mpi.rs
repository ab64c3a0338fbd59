//! Computes the chunks of a sweep on the ranks of an MPI job.
//!
//! Rank 0 reads the sweep, sends chunks to free ranks, sorts the rows and writes them; it computes nothing itself. The other ranks
//! need no file: they receive the sweep as text. The bytes in the folder are those of [`run`](super::run), and each of the two
//! can resume a sweep of the other. A single rank computes on its threads.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};

use mpi::topology::SimpleCommunicator;
use mpi::traits::*;

use super::assembly::{Assembly, Order};
use super::definition::Sweep;
use super::error::SweepError;
use super::finish;
use super::folder::Folder;
use super::part::Part;
use super::row;
use super::run as run_on_threads;
use super::status::{Sink, Status};
use super::tally::Tally;
use super::threads::BETWEEN_WRITES;

/// Pause of rank 0 if there is no message. Waiting inside MPI would occupy a whole core.
const REST: Duration = Duration::from_micros(200);
/// In place of a chunk's number: from rank 0, all work is done; to rank 0, a signal was received.
const END: u64 = u64::MAX;

/// Computes a part of a sweep as [`run`](super::run) does, over all ranks of the MPI job that this process belongs to.
/// `read` is called on rank 0 only. Rank 0 returns the result, the other ranks return `None`.
///
/// # Errors
/// As [`run`](super::run), on rank 0; MPI that cannot be used.
pub fn run(
    read: impl FnOnce() -> Result<Sweep, SweepError>,
    part: Part,
    path: &Path,
    stop: &AtomicBool,
    tell: &mut dyn FnMut(Status),
) -> Result<Option<Tally>, SweepError> {
    let refused = || SweepError::Refused("MPI cannot be used in this process".to_owned());
    let universe = mpi::initialize().ok_or_else(refused)?;
    let world = universe.world();
    if world.size() == 1 {
        return run_on_threads(&read()?, part, path, 0, stop, tell).map(Some);
    }
    if world.rank() != 0 {
        work(&world, stop);
        return Ok(None);
    }
    let begun = read().and_then(|sweep| {
        sweep.check_undivided()?;
        let folder = Folder::open(path, &sweep, part)?;
        Ok((sweep, folder))
    });
    let text = match &begun {
        Ok((sweep, folder)) if !folder.progress().finished => sweep.canonical().to_string(),
        // the other ranks have no work
        _ => String::new(),
    };
    share(&world, text.into_bytes());
    let (sweep, mut folder) = begun?;
    tell(Status::of(&sweep, part, &folder));
    if folder.progress().finished {
        return finish::summary(&sweep, part, &mut folder).map(Some);
    }
    lead(&world, &sweep, part, &mut folder, stop, tell)?;
    finish::finish(&sweep, part, &mut folder).map(Some)
}

/// Sends the bytes of rank 0 to all ranks.
fn share(world: &SimpleCommunicator, mut bytes: Vec<u8>) -> Vec<u8> {
    let root = world.process_at_rank(0);
    let mut length = bytes.len() as u64;
    root.broadcast_into(&mut length);
    bytes.resize(length as usize, 0);
    // MPI cannot send an empty message
    if length > 0 {
        root.broadcast_into(&mut bytes[..]);
    }
    bytes
}

/// Work of every rank except the first: requests chunks and returns their rows until none is left.
fn work(world: &SimpleCommunicator, stop: &AtomicBool) {
    let text = share(world, Vec::new());
    // rank 0 has read the same text, so it is a valid sweep unless there is no work
    let tree = serde_json::from_slice(&text).ok();
    let Some(sweep) = tree.and_then(|tree| Sweep::from_value(&tree).ok()) else { return };
    let lead = world.process_at_rank(0);
    // a message is a chunk's number and its rows; the first is too short for a number, that after a stop has END as its
    let (mut message, mut kept) = (vec![0], sweep.results().kept());
    loop {
        lead.send(&message[..]);
        let (chunk, _) = lead.receive::<u64>();
        if chunk == END {
            return;
        }
        message = match row::rows(&sweep, chunk, &mut kept, || stop.load(Ordering::Relaxed)) {
            Some(rows) => [&chunk.to_le_bytes()[..], &rows].concat(),
            None => END.to_le_bytes().to_vec(),
        };
    }
}

/// Work of rank 0: sends chunks and writes the returned rows.
fn lead(
    world: &SimpleCommunicator,
    sweep: &Sweep,
    part: Part,
    folder: &mut Folder,
    stop: &AtomicBool,
    tell: &mut dyn FnMut(Status),
) -> Result<(), SweepError> {
    let chunks = part.chunks(sweep.chunks());
    let workers = world.size() as usize - 1;
    let mut assembly = Assembly::new((chunks.start + folder.progress().chunks)..chunks.end, workers);
    let mut waiting: Vec<mpi::Rank> = Vec::new();
    let mut working = workers;
    let mut last = Instant::now();
    let mut given_up = false;
    let mut written = Ok(());
    // until every worker has received the message to stop, also after an error
    while working > 0 {
        match world.any_process().immediate_matched_probe() {
            Some(message) => {
                let (bytes, status) = message.matched_receive_vec::<u8>();
                if let Some((number, rows)) = bytes.split_first_chunk::<8>() {
                    match u64::from_le_bytes(*number) {
                        END => given_up = true,
                        chunk => assembly.take_in(chunk, rows.to_vec()),
                    }
                }
                waiting.push(status.source_rank());
            }
            None => sleep(REST),
        }
        let ended = given_up || written.is_err() || stop.load(Ordering::Relaxed);
        while let Some(rank) = waiting.pop() {
            let order = if ended { Order::Done } else { assembly.hand_out() };
            let chunk = match order {
                Order::Chunk(chunk) => chunk,
                Order::Done => END,
                Order::Wait => {
                    waiting.push(rank);
                    break;
                }
            };
            working -= usize::from(chunk == END);
            world.process_at_rank(rank).send(&chunk);
        }
        if written.is_ok() && (working == 0 || last.elapsed() >= BETWEEN_WRITES) {
            last = Instant::now();
            let (chunks, rows) = assembly.take_ready();
            if chunks > 0 {
                written = folder.append(chunks, &rows);
            }
            tell(Status::of(sweep, part, folder));
        }
    }
    written?;
    if assembly.is_complete() {
        return Ok(());
    }
    let Status { done, points } = Status::of(sweep, part, folder);
    Err(SweepError::Stopped { done, points })
}
