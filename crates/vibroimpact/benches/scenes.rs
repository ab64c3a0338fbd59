//! Time from the text of a scene to the solver's problem, to the rebound, and to the result that `simulate --json` prints.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use vibroimpact::Scene;

const SCENE: &str = include_str!("../../../datasets/scenes/stepped-cantilever.json");

fn scenes(criterion: &mut Criterion) {
    criterion.bench_function("scene/read", |bencher| bencher.iter(|| Scene::from_json(black_box(SCENE))));
    let scene = Scene::from_json(SCENE).expect("a scene of the gallery");
    criterion.bench_function("scene/to modes", |bencher| bencher.iter(|| black_box(&scene).impact()));
    let impact = scene.impact().expect("a scene of the gallery");
    criterion.bench_function("scene/solve", |bencher| bencher.iter(|| black_box(&impact).solve()));
    criterion.bench_function("scene/solve and record", |bencher| bencher.iter(|| black_box(&impact).record()));
    let simulate = |text: &str| -> Result<String, vibroimpact::export::Failure> {
        let scene = Scene::from_json(text)?;
        scene.simulate()?.json(&scene)
    };
    assert!(simulate(SCENE).is_ok(), "a scene of the gallery");
    criterion.bench_function("scene/simulate", |bencher| bencher.iter(|| simulate(black_box(SCENE))));
}

criterion_group!(benches, scenes);
criterion_main!(benches);
