//! scratch
use fracdiff::*;
fn main() {
    for s in [1.0f64, 15.0, 1e5] {
        for tol in [1e-10, 1e-12, 1e-13] {
            let p = Volterra::scalar(|t| t, move |_, x| s.sqrt() * x.max(0.0).powf(1.5), &[(2.0, -1.0), (1.5, -1.0)])
                .with_event(Event::new(|_, y| y[0]));
            let now = std::time::Instant::now();
            let r = p.solve(&Method::Collocation(Collocation { tolerance: tol, ..Default::default() }), 200.0).unwrap();
            println!("S={s} tol={tol:e} {:?} {:?} {:.1?}", r.stop, r.counts, now.elapsed());
            for e in &r.events {
                print!("{:.14} ", e.t);
            }
            println!("\n end {:e}", r.at(r.end_time()).unwrap()[0]);
        }
        for steps in [4000, 16000] {
            let p = Volterra::scalar(|t| t, move |_, x| s.sqrt() * x.max(0.0).powf(1.5), &[(2.0, -1.0), (1.5, -1.0)])
                .with_event(Event::new(|_, y| y[0]));
            let r = p.solve(&Method::Trapezoidal(Convolution { steps }), 20.0).unwrap();
            for e in &r.events {
                print!("{:.14} ", e.t);
            }
            println!();
        }
    }
}
