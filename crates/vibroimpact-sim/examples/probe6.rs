use vibroimpact_sim::infinite::*;
fn main() {
    for n in [4, 6, 8, 10, 12] { for v in [70.0, 125.0] { println!("{n} {v} {:?}", FirstContact::at_speed(v, n).map(|c| (c.mass, c.s, c.rebound_ratio()))); } }
    let set = Settings { estimate_error: false, ..Settings::default() };
    for s in [1e-10, 1e-3, 1.0, 15.0, 100.0, 1e3, 5e3, 1.2e4, 2e4, 3e4, 3.5e4] {
        let full = solve(Structure::Beam, s, &set).unwrap();
        print!("{s:e} full {:.6} {:.6}", full.first_rebound_ratio().unwrap(), full.contacts[0].duration.unwrap());
        for n in [6, 8, 12] { print!(" | {n} {:?}", FirstContact::at_s(s, n).map(|c| (c.rebound_ratio(), c.duration(), c.speed)).ok()); }
        println!();
    }
    for s in [1e-6, 1.0, 1e2, 1e4, 1e6, 1e8] { let r = solve(Structure::Plate, s, &Settings::default()).unwrap(); println!("plate {s:e} {:?} {:?} {:?} {:?}", r.outcome, r.rebound_ratio(), r.contacts[0].duration, r.error); }
}
