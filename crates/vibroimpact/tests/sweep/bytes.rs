//! The output is correct, complete, and the same to the byte for any number of threads.

use super::*;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use vibroimpact::Scene;

#[test]
fn the_bytes_do_not_depend_on_the_threads() {
    let bench = Bench::new(&super::sweep());
    for threads in ["1", "2", "4"] {
        bench.succeeds(&["sweep", "sweep.json", "--out", threads, "--threads", threads, "--quiet"]);
    }
    assert_same(&bench.path("1"), &bench.path("2"));
    assert_same(&bench.path("1"), &bench.path("4"));
    let names: Vec<String> = files(&bench.path("1")).into_iter().map(|(name, _)| name).collect();
    let expected = [
        "figures/maps.svg",
        "progress.json",
        "report.html",
        "report.md",
        "results.csv",
        "results.parquet",
        "summary.json",
        "sweep.json",
    ];
    assert_eq!(names, expected);
}

#[test]
fn rows_contain_the_results_of_their_scenes() {
    let bench = Bench::new(&super::sweep());
    let printed = bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--json"]);
    let rows = bench.rows("out");
    assert_eq!(rows.len(), 600);
    let header = String::from_utf8(bench.read("out/results.csv")).unwrap();
    assert!(header.starts_with(
        "index,striker.mass_kg,modes,striker.speed_m_s,structure.shape_at_location[1],outcome,restitution,\
         restitution_uncertainty,uncertainty_solver,uncertainty_modes_left_out,uncertainty_beam_theory,settled,spread,\
         sub_impact_count,model,mode_count,residual_compliance_m_n,solves,modes_computed,contact_steps,rejected_steps,newton_iterations,law_evaluations,flight_steps,mode_steps,panels,\
         stopped_by,error\n"
    ));
    let mut failed = 0;
    for (point, row) in rows.iter().enumerate() {
        assert_eq!(row[0], point.to_string());
        let modes: usize = row[2].parse().unwrap();
        let error = row.get(row.len() - 1).unwrap();
        if modes > 3 {
            failed += 1;
            assert_eq!(error, "modes = 4 is not allowed; it must be at most 3, the number of listed modes");
            assert!(row.iter().skip(5).take(row.len() - 6).all(str::is_empty), "{row:?}");
            continue;
        }
        assert_eq!(error, "");
        // The columns are the whole scene: solving it directly gives the same digits.
        if point % 50 < 2 {
            let mut scene = scene();
            let number = |column: usize| json!(row[column].parse::<f64>().unwrap());
            scene["striker"] = json!({ "mass_kg": number(1), "speed_m_s": number(3) });
            scene["modes"] = json!(modes);
            scene["structure"]["shape_at_location"][1] = number(4);
            let answer = Scene::from_value(&scene).unwrap().answer().unwrap();
            assert_eq!(&row[5], answer.outcome);
            assert_eq!(row[6].parse::<f64>().ok(), answer.restitution);
            assert_eq!(row[7].parse::<f64>().ok(), answer.restitution_uncertainty);
            let parts = [8, 9, 10].map(|column| row[column].parse::<f64>().ok());
            assert_eq!(parts, answer.uncertainty.parts().map(|(_, part)| part));
            assert_eq!(row[11], answer.settled.to_string());
            assert_eq!(row[12].parse::<f64>().ok(), answer.spread);
            assert_eq!(row[13].parse::<usize>().ok(), answer.sub_impact_count);
            assert_eq!((&row[14], &row[15]), ("modal", &*modes.to_string()));
            let counts = [17, 18, 19, 20, 21, 22, 23, 24, 25].map(|column| row[column].parse::<u64>().unwrap());
            let cost = answer.cost;
            let expected = [
                cost.solves,
                cost.modes_computed,
                cost.contact_steps,
                cost.rejected_steps,
                cost.newton_iterations,
                cost.law_evaluations,
                cost.flight_steps,
                cost.mode_steps,
                cost.panels,
            ];
            assert_eq!(counts, expected);
        }
    }
    assert_eq!(failed, 200);

    let summary: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!((&summary["points"], &summary["failures"]), (&json!(600), &json!(200)));
    assert_eq!(summary["outcomes"]["rebound"], 400);
    assert_eq!(summary["first_failures"][0]["index"], 40);
    assert_eq!(summary["computed_points"], 600);
    let unsettled = rows.iter().filter(|row| &row[11] == "false").count();
    assert_eq!(summary["unsettled"], unsettled);
    let mode_steps: u64 = rows.iter().filter_map(|row| row[24].parse::<u64>().ok()).sum();
    assert_eq!(summary["mode_steps"], mode_steps);
    let restitutions = || rows.iter().filter_map(|row| row[6].parse::<f64>().ok());
    assert_eq!(summary["restitution"]["least"].as_f64().unwrap(), restitutions().fold(f64::INFINITY, f64::min));
    assert_eq!(summary["restitution"]["greatest"].as_f64().unwrap(), restitutions().fold(0.0, f64::max));
}

#[test]
fn parquet_read_back_equals_csv() {
    let bench = Bench::new(&super::sweep());
    bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
    let reader = SerializedFileReader::new(fs::File::open(bench.path("out/results.parquet")).unwrap()).unwrap();
    let header = csv::Reader::from_reader(&bench.read("out/results.csv")[..]).headers().unwrap().clone();
    let rows = bench.rows("out");
    let mut count = 0;
    for (found, row) in reader.get_row_iter(None).unwrap().zip(&rows) {
        let found = found.unwrap();
        for ((name, value), (column, cell)) in found.get_column_iter().zip(header.iter().zip(row)) {
            assert_eq!(name, column);
            match value {
                Field::Null => assert_eq!(cell, ""),
                Field::Long(value) => assert_eq!(cell, value.to_string()),
                Field::Double(value) => assert_eq!(cell.parse::<f64>().unwrap().to_bits(), value.to_bits()),
                Field::Bool(value) => assert_eq!(cell, value.to_string()),
                Field::Str(value) => assert_eq!(cell, value),
                other => panic!("{other:?}"),
            }
        }
        count += 1;
    }
    assert_eq!((count, reader.metadata().file_metadata().num_rows()), (rows.len(), rows.len() as i64));
}

#[test]
fn infinite_structures_can_be_swept() {
    let bench = Bench::new(&json!({
        "scene": {
            "structure": { "kind": "infinite-beam", "youngs_modulus_pa": 2e11, "density_kg_m3": 7800,
                           "width_m": 0.028, "thickness_m": 0.028 },
            "striker": { "density_kg_m3": 7800, "radius_m": 0.01, "speed_m_s": 0.5 },
            "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 }
        },
        "vary": [{ "field": "striker.radius_m", "from": 0.01, "to": 0.033, "count": 6 }]
    }));
    bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
    let rows = bench.rows("out");
    assert!(rows.iter().all(|row| &row[11] == "infinite-beam" && row[22].parse::<u64>().unwrap() > 0));
    // A small ball rebounds, that of S = 15 stays in contact.
    assert_eq!((&rows[0][2], &rows[5][2]), ("rebound", "sustained"));
    assert!(rows[0][4].parse::<f64>().unwrap() < 1e-6);
}

#[test]
fn the_report_is_self_contained_and_text_is_for_readers() {
    let bench = Bench::new(&super::sweep());
    let printed = bench.succeeds(&["sweep", "sweep.json", "--out", "out"]);
    for part in ["points", "600", "400 rebound", "failed", "point 40: modes = 4", "a second"] {
        assert!(printed.contains(part), "{part} in\n{printed}");
    }
    let report = String::from_utf8(bench.read("out/report.html")).unwrap();
    assert!(report.contains("<svg") && !report.contains("<img"));
    assert!(report.contains("striker.mass_kg") && report.contains("0.01 to 1, logarithmic"));
}

#[test]
fn the_program_chooses_the_model_unless_the_scene_states_it() {
    let beam = json!({
        "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02,
                       "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
        "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 1.8e10 }
    });
    let bench = Bench::new(&json!({
        "scene": beam,
        "vary": [{ "field": "model", "values": ["auto", "rigid", "emoc"] },
                 { "field": "location_m", "values": [0, 0.4] }]
    }));
    bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
    let rows = bench.rows("out");
    let models: Vec<&str> = rows.iter().map(|row| &row[12]).collect();
    assert_eq!(models, ["rigid", "modal", "rigid", "rigid", "emoc", "emoc"]);
    // On the support the result is exact; elsewhere it has the default tolerance, or the bound for a wall.
    assert_eq!((&rows[0][4], &rows[0][9]), ("1.0", "true"));
    assert_eq!(&rows[1][9], "true");
    assert!(rows[1][5].parse::<f64>().unwrap() <= vibroimpact::model::DEFAULT_TOLERANCE);
    assert_eq!(&rows[3][9], "false");
    let mut scene = beam;
    scene["location_m"] = json!(0.4);
    let answer = Scene::from_value(&scene).unwrap().answer().unwrap();
    assert_eq!(rows[1][4].parse::<f64>().ok(), answer.restitution);
    assert_eq!(rows[1][13], answer.modes.to_string());
    assert_eq!(rows[1][14].parse::<f64>().unwrap(), answer.residual_compliance_m_n);
}
