use vibroimpact_sim::infinite::*;
fn main() {
    let n: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let t = std::time::Instant::now();
    let c = critical_s();
    println!("{c:?} {:?}", t.elapsed());
    let t = std::time::Instant::now();
    for p in turning_points(n).unwrap() {
        println!("{p:?} rel {:.1e} {:?}", p.uncertainty / p.s, t.elapsed());
    }
}
