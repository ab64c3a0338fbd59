use vibroimpact_sim::infinite::*;
fn main() {
    let s: f64 = std::env::args().nth(1).unwrap().parse().unwrap();
    for tolerance in [1e-10, 1e-12, 1e-14] {
        for nodes in [12, 14, 16, 18, 20, 22, 24, 26, 28, 32] {
            let mut best = f64::INFINITY;
            let set = Settings { estimate_error: false, nodes, tolerance, ..Settings::default() };
            let mut r = solve(Structure::Beam, s, &set).unwrap();
            for _ in 0..5 {
                let t = std::time::Instant::now();
                r = solve(Structure::Beam, s, &set).unwrap();
                best = best.min(t.elapsed().as_secs_f64());
            }
            println!(
                "{tolerance:e} {nodes} {:.1} us {}/{} {:.16} {:.16} {:.16e} {:.16e}",
                best * 1e6,
                r.panels,
                r.panels_tried,
                r.contacts[0].duration.unwrap(),
                r.contacts[0].body_speed_at_end.unwrap(),
                r.contacts.get(1).map_or(0., |c| c.start),
                r.contacts.get(1).map_or(0., |c| c.closing_speed)
            );
        }
    }
}
