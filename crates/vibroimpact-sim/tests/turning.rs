//! A solver that is moved from location to location of a structure, or shared by threads, gives the results of a new one, to
//! the last bit.

use crate::common::{ball, hertz, pinned, settings};
use vibroimpact_sim::modal::{Settings, Solver, Start, Striker, Structure};

#[test]
fn a_solver_moved_to_another_location_equals_a_new_one() {
    // A node of every fifth mode, where fewer modes move; locations near an end; other damping; other modes.
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
fn an_invalid_structure_is_refused_and_the_solver_does_not_change() {
    let beam = pinned(10, 0.02, 0.4);
    let mut solver = Solver::new(&beam).unwrap();
    let mut broken = beam.clone();
    broken.modes[3].shape = f64::NAN;
    assert_eq!(solver.turn_to(&broken).unwrap_err().field, "modes[3].shape");
    let settings = settings(1e-5);
    let new = Solver::new(&beam).unwrap().solve(&ball(), &hertz(), None, &settings);
    assert_eq!(solver.solve(&ball(), &hertz(), None, &settings), new);
}

/// Threads build the tables of a solver together and get the results that each would get alone. Strikers differ, and hence the
/// rigid modes; one of them is at rest, and every second thread records the motion with its ledger.
#[test]
fn threads_share_a_solver_with_the_same_bits() {
    let beam = pinned(40, 0.02, 0.618);
    let settings = settings(1e-5);
    let strikers: Vec<Striker> = (1..=8).map(|i| Striker { mass_kg: 0.02 * f64::from(i), ..ball() }).collect();
    let stop = Striker { mass_kg: f64::INFINITY, speed_m_s: 0.0 };
    let swings = Start { rate: (0..40).map(|k| if k == 0 { 0.1 } else { 0.0 }).collect(), ..Start::at_rest(40) };
    let alone = |striker: &Striker, start: Option<&Start>| {
        let found = Solver::new(&beam).unwrap().record(striker, &hertz(), start, &settings);
        found.map(|(solution, history)| (solution, history.energy_ledger())).unwrap()
    };
    let expected: Vec<_> = strikers.iter().map(|striker| alone(striker, None)).collect();
    let stopped = alone(&stop, Some(&swings));
    for _ in 0..4 {
        let shared = Solver::new(&beam).unwrap();
        let find = |i: usize| {
            for turn in 0..strikers.len() {
                let k = (i + turn) % strikers.len();
                if (i + turn).is_multiple_of(2) {
                    let solution = shared.solve(&strikers[k], &hertz(), None, &settings).unwrap();
                    assert_eq!(solution, expected[k].0);
                } else {
                    let (solution, history) = shared.record(&strikers[k], &hertz(), None, &settings).unwrap();
                    assert_eq!((solution, history.energy_ledger()), expected[k]);
                }
            }
            let (solution, _) = shared.record(&stop, &hertz(), Some(&swings), &settings).unwrap();
            assert_eq!(solution, stopped.0);
        };
        std::thread::scope(|scope| {
            let find = &find;
            (0..strikers.len()).for_each(|i| drop(scope.spawn(move || find(i))));
        });
    }
}
