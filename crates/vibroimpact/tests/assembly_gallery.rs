//! The gallery of scenes of bodies: the results in a table, and the pictures.

use std::fmt::Write;
use std::fs;

use crate::gallery::{assemblies, assert_checked_in, datasets, with_history};
use vibroimpact::assembly::{Summary, headline, picture};
use vibroimpact::plot::Format;
use vibroimpact::text::quantity;

const ABOUT: &str = "# Gallery of scenes of bodies\n\n\
    A test runs each of these scenes, and each has another test of its physics (`crates/vibroimpact/tests/assembly_physics.rs`).\n\
    `vibroimpact simulate NAME.json` gives these results in full; the table and the pictures are written by\n\
    `crates/vibroimpact/tests/assembly_gallery.rs` with `VIBROIMPACT_BLESS=1`. Where the times of the touches are certain to\n\
    the end, their number is stated. A sweep maps the motion to which each start leads:\n\
    [basins of a ball on a shaken table](../sweeps/shaken-table-basins.json),\n\
    [picture](../../docs/figures/shaken-table-basins.png).\n\n\
    | scene | outcome | touches | largest force | description |\n\
    |---|---|---|---|---|\n";

#[test]
fn the_table_of_the_gallery_is_current() {
    let mut table = ABOUT.to_owned();
    for (name, scene) in assemblies() {
        let found = with_history(&scene);
        let summary = Summary::new(&found);
        let certain = summary.reliable_until_s == Some(summary.end_s);
        let touches: u64 = summary.contacts.values().map(|contact| contact.count).sum();
        let touches = if certain { touches.to_string() } else { "not certain".to_owned() };
        let force = summary.contacts.values().map(|contact| contact.largest_force_n).fold(0.0, f64::max);
        let force = if certain { quantity(force, "N") } else { String::new() };
        let description = scene.description.as_deref().unwrap_or_default();
        writeln!(
            table,
            "| [{name}.json]({name}.json), [picture]({name}.png) | {} | {touches} | {force} | {description} |",
            summary.outcome
        )
        .unwrap();
        let file = datasets(&format!("assemblies/{name}.png"));
        if std::env::var_os("VIBROIMPACT_BLESS").is_some() {
            let figure = picture(&headline(&scene, &found.posed), &found);
            fs::write(&file, figure.bytes(Format::Png).unwrap()).unwrap();
        }
        assert!(file.exists(), "{}", file.display());
    }
    assert_checked_in("assemblies/README.md", &table);
}
