//! A solver that is turned from place to place of a structure finds what a new one finds, to the last bit.

mod common;

use common::{ball, hertz, pinned, settings};
use vibroimpact_sim::modal::{Settings, Solver, Structure};

#[test]
fn a_solver_turned_to_another_place_is_as_a_new_one() {
    // a node of every fifth mode, where fewer modes move; places near an end; other damping; other modes
    let mut beams: Vec<Structure> = [0.618, 0.4, 0.02, 0.4, 0.999, 0.5].map(|place| pinned(40, 0.02, place)).into();
    beams.extend([pinned(40, 0.0, 0.618), pinned(12, 0.02, 0.3), pinned(40, 0.02, 0.3)]);
    for estimate_uncertainty in [false, true] {
        let settings = Settings { estimate_uncertainty, ..settings(1e-5) };
        let mut turned = Solver::new(&beams[0]).unwrap();
        for beam in &beams {
            turned.turn_to(beam).unwrap();
            let found = turned.solve(&ball(), &hertz(), None, &settings).unwrap();
            let new = Solver::new(beam).unwrap().solve(&ball(), &hertz(), None, &settings).unwrap();
            assert_eq!(found, new);
        }
    }
}

#[test]
fn a_structure_that_is_none_is_refused_and_the_solver_stays_as_it_was() {
    let beam = pinned(10, 0.02, 0.4);
    let mut solver = Solver::new(&beam).unwrap();
    let mut broken = beam.clone();
    broken.modes[3].shape = f64::NAN;
    assert_eq!(solver.turn_to(&broken).unwrap_err().field, "modes[3].shape");
    let settings = settings(1e-5);
    let new = Solver::new(&beam).unwrap().solve(&ball(), &hertz(), None, &settings);
    assert_eq!(solver.solve(&ball(), &hertz(), None, &settings), new);
}
