use beam_modes::*;
use std::time::Instant;
#[test]
fn try_it() {
    let s = |l: f64, ei: f64, m: f64| Segment { length_m: l, flexural_rigidity_n_m2: ei, mass_per_length_kg_m: m };
    use End::*;
    for a in [Clamped, Pinned, Free, Guided] {
        for b in [Clamped, Pinned, Free, Guided] {
            let u = Beam { segments: vec![s(1.0, 1.0, 1.0)], ends: [a, b] };
            let v = Beam { segments: vec![s(0.3, 1.0, 1.0), s(0.7, 1.0 + 1e-15, 1.0)], ends: [a, b] };
            let w = Beam { segments: vec![s(0.5, 1.0, 1.0), s(0.001, 1.0 + 1e-15, 1.0),s(0.499, 1.0,1.0)], ends: [a, b] };
            let (u, v, w) = (u.modes(100).unwrap(), v.modes(100).unwrap(), w.modes(100).unwrap());
            let mut worst = [0.0f64; 4];
            for k in 0..100 {
                let (p, q, r) = (u.omega_rad_s()[k], v.omega_rad_s()[k], w.omega_rad_s()[k]);
                if p > 0.0 {
                    worst[0] = worst[0].max((q / p - 1.0).abs());
                    worst[1] = worst[1].max((r / p - 1.0).abs());
                }
                for x in [0.0, 0.1, 0.3, 0.5, 0.5005, 0.77, 1.0] {
                    worst[2] = worst[2].max((u.shape(k, x).unwrap() - v.shape(k, x).unwrap()).abs());
                    worst[3] = worst[3].max((u.shape(k, x).unwrap() - w.shape(k, x).unwrap()).abs());
                }
            }
            println!("{a:?} {b:?} {:?} {:?} {worst:?}", &u.omega_rad_s()[..3], u.rigid_body_count());
        }
    }
    let st = Beam { segments: vec![s(0.5, 1.0, 1.0), s(0.5, 0.2, 0.5)], ends: [Clamped, Free] };
    for _ in 0..5 {
        let t = Instant::now();
        let m = st.modes(500).unwrap();
        println!("500 modes {:?} {}", t.elapsed(), m.omega_rad_s()[499]);
    }
    let st = Beam { segments: vec![s(0.5, 1.0, 1.0)], ends: [Pinned, Pinned] };
    for _ in 0..5 {
        let t = Instant::now();
        let m = st.modes(40).unwrap();
        println!("40 modes {:?} {}", t.elapsed(), m.omega_rad_s()[39]);
    }
}
#[test]
fn dbg() {
    let s = |l: f64, ei: f64, m: f64| Segment { length_m: l, flexural_rigidity_n_m2: ei, mass_per_length_kg_m: m };
    use End::*;
    for (a,b) in [(Free,Pinned),(Free,Free),(Guided,Guided)] {
            let u = Beam { segments: vec![s(1.0, 1.0, 1.0)], ends: [a, b] };
            let w = Beam { segments: vec![s(0.5, 1.0, 1.0), s(0.001, 1.0 + 1e-15, 1.0),s(0.499, 1.0,1.0)], ends: [a, b] };
            let (u, w) = (u.modes(100).unwrap(), w.modes(100).unwrap());
            for k in 0..100 { let r=w.omega_rad_s()[k]/u.omega_rad_s()[k]; if (r-1.0).abs()>1e-14 {println!("{k} {r} {:?}",&w.omega_rad_s()[k..k+3]);break;} }
    }
}
