//! x
fn main() {
    let impacts = work_precision::impact::library().unwrap();
    let a: Vec<String> = std::env::args().collect();
    if a[1] == "export" { work_precision::export::write(&impacts, std::path::Path::new(&a[2])).unwrap(); return; }
    for i in &impacts { if i.name.contains(&a[1]) {
        for r in work_precision::impact::rows(i, &work_precision::measure::Effort::FULL).unwrap() {
            if r.norm.is_empty() || r.norm == "restitution" { println!("{:18} {:32} {:.0e} {:10.3e} {:10.3e} {:?} {}", r.problem, r.solver, r.setting, r.error.unwrap_or(f64::NAN), r.time_s.unwrap_or(f64::NAN), r.cost, r.status); }
        }
    } }
}
