//! Time of a force in the inner loop of a solver, and of the restitution of a rigid striker at a wall.

use contact_models::{
    ContactLaw, Felt, Flores, Hertz, HuntCrossley, Hysteretic, InvalidInput, KelvinVoigt, Law, Memory, Thornton,
    Viscous,
};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn laws() -> Result<Vec<Law>, InvalidInput> {
    let k = 1.7945e10;
    Ok(vec![
        Hertz::new(k)?.into(),
        Viscous::with_restitution(k, 0.95, 1.0)?.into(),
        Hysteretic { stiffness_n_m1_5: k, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 5e-8 }.validated()?.into(),
        HuntCrossley::new(k, 1.5, 0.2)?.into(),
        KelvinVoigt::new(1e8, 200.0)?.into(),
        Flores::new(k, 0.8)?.into(),
        Felt::new(4.5e9, 2.5, 1e-4)?.into(),
        Thornton::new(1.1e11, 0.015, 2e9)?.into(),
    ])
}

fn forces_and_walls(criterion: &mut Criterion) {
    for law in laws().expect("parameters in range") {
        let branch = law.touch(&Memory::default(), 1.0);
        criterion.bench_function(&format!("force/{}", law.name()), |bencher| {
            bencher.iter(|| law.force(black_box(&branch), black_box(1e-5), black_box(0.5)))
        });
        criterion.bench_function(&format!("wall/{}", law.name()), |bencher| {
            bencher.iter(|| law.wall_restitution(black_box(0.11), black_box(1.0)))
        });
    }
}

criterion_group!(benches, forces_and_walls);
criterion_main!(benches);
