use vibroimpact_sim::infinite::*;
fn main() {
    let s: f64 = std::env::args().nth(1).unwrap().parse().unwrap();
    let go = |nodes, tolerance| {
        solve(Structure::Beam, s, &Settings { estimate_error: false, nodes, tolerance, ..Settings::default() }).unwrap()
    };
    let r = go(24, 1e-14);
    let r2 = go(28, 1e-14);
    let sets = [(16, 1e-10), (16, 1e-12), (20, 1e-12), (20, 1e-13), (24, 1e-13)];
    let sols: Vec<_> = sets.iter().map(|&(n, t)| go(n, t)).chain([r2]).collect();
    for (i, c) in r.contacts.iter().enumerate() {
        print!(
            "{i:3} {:.12e} {:.3e} v0={:.3e} u={:.2e} |",
            c.start,
            c.duration.unwrap_or(0.0),
            c.closing_speed,
            c.body_speed_at_end.unwrap_or(0.0)
        );
        for q in &sols {
            if let Some(d) = q.contacts.get(i) {
                print!(
                    " {:.0e}/{:.0e}/{:.0e}",
                    (d.start / c.start - 1.0).abs(),
                    (d.closing_speed / c.closing_speed - 1.0).abs(),
                    (d.duration.unwrap_or(0.0) / c.duration.unwrap_or(0.0) - 1.0).abs()
                );
            }
        }
        println!();
    }
}
