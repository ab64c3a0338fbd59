//! From a scene to its answer. This is the one place where sweeps and solvers meet.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::model::{Answer, Kept};
use crate::scene::{InvalidInput, Scene};

/// Whether a scene can be solved, as far as can be told without solving it. A fault in the program itself is left to
/// the rows.
pub(super) fn check(scene: &Scene) -> Result<(), InvalidInput> {
    catch_unwind(AssertUnwindSafe(|| scene.check())).unwrap_or(Ok(()))
}

/// Solves a scene; `Err` says why it could not be solved, whatever went wrong.
pub(super) fn evaluate(scene: Result<Scene, InvalidInput>, kept: &mut Kept) -> Result<Answer, String> {
    let answer = guarded(|| scene?.answer_with(kept));
    if answer.is_err() {
        // what a solver that failed has left may be anything
        *kept = Kept::default();
    }
    answer
}

fn guarded(solve: impl FnOnce() -> Result<Answer, InvalidInput>) -> Result<Answer, String> {
    match catch_unwind(AssertUnwindSafe(solve)) {
        Ok(answer) => answer.map_err(|fault| fault.to_string()),
        Err(panic) => {
            let said = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
            let said = said.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
            Err(format!("the solver failed: {said}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_in_a_solver_is_an_answer() {
        assert_eq!(guarded(|| panic!("no root in {}", 3)), Err("the solver failed: no root in 3".to_owned()));
        let fault = || Err(InvalidInput::new("a", "1", "2"));
        assert_eq!(guarded(fault), Err("a = 1 is not allowed: 2".to_owned()));
    }
}
