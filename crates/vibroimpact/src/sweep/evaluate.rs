//! Solves a scene and formats its cells. Only this file of sweeps uses the solvers.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};

use invalid_input::InvalidInput;
use vibroimpact_sim::assembly::{Outcome, Reason};

use super::results::{Results, of_draw, of_impact};
use crate::assembly::{AnyScene, MOST_INTERVALS, Wanted};
use crate::model::Kept;

/// Checks whether a scene can be solved, without solving it. Errors of the program itself are reported in the rows.
pub(super) fn check(scene: &AnyScene) -> Result<(), InvalidInput> {
    let check = || match scene {
        AnyScene::Impact(scene) => scene.check(),
        AnyScene::Bodies(scene) => scene.pose().map(drop),
    };
    catch_unwind(AssertUnwindSafe(check)).unwrap_or(Ok(()))
}

/// Solves a scene; `Err` is the reason why it could not be solved, including a panic. `None` if `stop` interrupted it.
pub(super) fn evaluate(
    scene: Result<AnyScene, InvalidInput>,
    results: &Results,
    kept: &mut Kept,
    stop: &dyn Fn() -> bool,
) -> Option<Result<Vec<String>, String>> {
    let cells = guarded(|| match (scene.map_err(|fault| fault.to_string())?, results) {
        (AnyScene::Impact(scene), Results::Impact) => {
            Ok(Some(of_impact(&scene.answer_with(kept).map_err(|fault| fault.to_string())?)))
        }
        (AnyScene::Impact(scene), Results::Draw) => {
            Ok(Some(of_draw(&scene.draw_with(kept).map_err(|fault| fault.to_string())?)))
        }
        (AnyScene::Bodies(scene), Results::Run { reliability, .. }) => {
            let ended = AtomicBool::new(false);
            let mut look = |_| ended.store(stop(), Ordering::Relaxed);
            // the reliability needs the intervals
            let (reliability, intervals) = (*reliability, if *reliability { MOST_INTERVALS } else { 0 });
            let wanted = Wanted { intervals, reliability, course: false, take: None, stop: &ended, tell: &mut look };
            let found = scene.simulate_with(wanted).map_err(|fault| fault.to_string())?;
            let whole = found.run.outcome != Outcome::Stopped(Reason::Interrupted) && !(reliability && stop());
            Ok(whole.then(|| results.of_run(&found)))
        }
        (AnyScene::Impact(_), _) => Err("bodies is missing; the first point of the sweep has it".to_owned()),
        (AnyScene::Bodies(_), _) => Err("bodies is too much; the first point of the sweep has none".to_owned()),
    });
    if cells.is_err() {
        // the memory of a failed solver may be inconsistent
        kept.clear();
    }
    cells.transpose()
}

fn guarded<T>(solve: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    match catch_unwind(AssertUnwindSafe(solve)) {
        Ok(solved) => solved,
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
        let failed: Result<(), String> = guarded(|| panic!("no root in {}", 3));
        assert_eq!(failed, Err("the solver failed: no root in 3".to_owned()));
        assert_eq!(guarded(|| Err::<(), _>("no".to_owned())), Err("no".to_owned()));
    }
}
