use vibroimpact_sim::infinite::*;
fn main() {
    let c = critical_s().s;
    for d in std::env::args().skip(1) {
        let s = c * (1.0 + d.parse::<f64>().unwrap());
        let t = std::time::Instant::now();
        let set = Settings { estimate_error: false, ..Settings::default() };
        let r = solve(Structure::Beam, s, &set).unwrap();
        let l = r.contacts.last().unwrap();
        println!(
            "{d} {:?} sep {} panels {}/{} known {:e} last {:?} {:?}",
            r.outcome,
            r.separations(),
            r.panels,
            r.panels_tried,
            r.known_until,
            l,
            t.elapsed()
        );
    }
}
