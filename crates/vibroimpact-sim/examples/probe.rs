use vibroimpact_sim::infinite::*;
fn main() {
    for s in std::env::args().skip(1) {
        let s: f64 = s.parse().unwrap();
        let mut best = f64::INFINITY;
        let set = Settings { estimate_error: false, ..Settings::default() };
        for _ in 0..20 {
            let t = std::time::Instant::now();
            let _ = solve(Structure::Beam, s, &set);
            best = best.min(t.elapsed().as_secs_f64());
        }
        let sol = solve(Structure::Beam, s, &Settings::default()).unwrap();
        println!(
            "S={s:e} {:?} sep={} err={:?} panels={}/{} time={:.1} us first={:?} known {:e}",
            sol.outcome,
            sol.separations(),
            sol.error,
            sol.panels,
            sol.panels_tried,
            best * 1e6,
            sol.first_rebound_ratio(),
            sol.known_until
        );
        for c in sol.contacts.iter().take(6) {
            println!("   {:.16e} dur {:?} v0 {:e} u {:?}", c.start, c.duration, c.closing_speed, c.body_speed_at_end);
        }
        for e in sol.extrema.iter().filter(|e| e.minimum).take(3) {
            println!("   min {:?}", e);
        }
    }
}
