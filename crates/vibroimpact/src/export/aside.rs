//! A folder in which files are completed before they appear under their names.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;

use tempfile::TempDir;

/// How the names of these folders begin. They are hidden, and belong to no other program.
const PREFIX: &str = ".vibroimpact-";
/// A file in each of them, which is locked as long as its process lives.
const LOCK: &str = "lock";

/// A temporary folder inside another one, which is removed when it is dropped. If the process is killed before that, the next one
/// that works in the same place removes it: the system releases the lock of a dead process, and only of a dead one.
#[derive(Debug)]
pub(crate) struct Aside {
    folder: TempDir,
    _lock: File,
}

impl Aside {
    /// Makes such a folder in another one, and removes those that dead processes have left there.
    pub fn new_in(place: &Path) -> io::Result<Aside> {
        for entry in fs::read_dir(place)?.flatten() {
            if entry.file_name().to_string_lossy().starts_with(PREFIX) {
                remove_if_dead(&entry.path());
            }
        }
        loop {
            let folder = tempfile::Builder::new().prefix(PREFIX).tempdir_in(place)?;
            let file = folder.path().join(LOCK);
            let lock = File::create_new(&file)?;
            // on a system without locks no process can find that another one is dead, and none removes its folder
            let taken = matches!(lock.try_lock(), Err(TryLockError::WouldBlock));
            // another process may have found the file before it was locked
            if !taken && file.exists() {
                return Ok(Aside { folder, _lock: lock });
            }
        }
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// Removes a folder whose process is dead. A folder that cannot be removed harms nobody.
fn remove_if_dead(folder: &Path) {
    if let Ok(lock) = File::open(folder.join(LOCK))
        && lock.try_lock().is_ok()
    {
        let _ = fs::remove_dir_all(folder);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_dead_process_has_left_is_removed_and_what_a_living_one_uses_is_not() {
        let place = tempfile::tempdir().unwrap();
        let dead = place.path().join(format!("{PREFIX}dead"));
        let other = place.path().join(".tmp-of-another-program");
        for folder in [&dead, &other] {
            fs::create_dir(folder).unwrap();
            for file in [LOCK, "result.json"] {
                fs::write(folder.join(file), "").unwrap();
            }
        }
        let living = Aside::new_in(place.path()).unwrap();
        fs::write(living.path().join("result.json"), "").unwrap();
        let second = Aside::new_in(place.path()).unwrap();
        assert!(!dead.exists() && other.exists() && second.path() != living.path());
        assert!(living.path().join("result.json").exists());
        drop((living, second));
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }
}
