mod common;
use common::*;
use contact_models::*;
use vibroimpact_sim::modal::*;
#[test]
fn scratch() {
    let b = (1.396839204769838f64 / 1.41421356).asin();
    let _ = b;
    for (b, damp, c, law, m, v) in [
        (
            0.32f64,
            0.0,
            7.778426353569805e-8,
            Law::from(Hertz::new(17331156749.777073).unwrap()),
            2.0906008147497515,
            4.086013680964277,
        ),
        (
            0.337,
            0.047728347855474716,
            2.9744130805296775e-8,
            Law::from(Hysteretic::new(6608692376.459647, 1.6, 1.4, 0.4, 5e-8).unwrap()),
            2.6387535597869674,
            1.5590651578333043,
        ),
    ] {
        for n in [5, 7] {
            let mut s = pinned(n, damp, b);
            s.residual_compliance_m_n = c;
            for t in [1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13] {
                let x = Solver::new(&s)
                    .unwrap()
                    .solve(&Striker { mass_kg: m, speed_m_s: v }, &law, None, &settings(t))
                    .unwrap();
                println!(
                    "{n} {t:e} {:?} {:?} {:?} {} {:?}",
                    x.outcome,
                    x.restitution,
                    x.restitution_uncertainty,
                    x.sub_impacts.len(),
                    x.counts
                );
                if x.outcome == Outcome::LimitReached {
                    let l = x.sub_impacts.last().unwrap();
                    println!("   {l:?} end {}", x.end_s);
                }
            }
        }
    }
}
