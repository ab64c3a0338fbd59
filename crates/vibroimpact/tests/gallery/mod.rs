//! The gallery of scenes, and files that are generated and checked in.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use vibroimpact::Scene;
use vibroimpact::assembly::{AssemblyScene, MOST_INTERVALS, Simulation, Wanted};

/// A path in the folder of data sets.
pub fn datasets(path: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../datasets").join(path)
}

/// The files of the gallery, in order of their names.
pub fn paths() -> Vec<PathBuf> {
    let is_scene =
        |path: &PathBuf| path.extension().is_some_and(|extension| extension == "json" || extension == "toml");
    let entries = fs::read_dir(datasets("scenes")).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).filter(is_scene).collect();
    paths.sort();
    paths
}

/// Name and scene, in order of the names.
pub fn gallery() -> Vec<(String, Scene)> {
    let name = |path: &PathBuf| path.file_stem().unwrap().to_string_lossy().into_owned();
    paths()
        .iter()
        .map(|path| (name(path), Scene::read(path).unwrap_or_else(|fault| panic!("{path:?}: {fault}"))))
        .collect()
}

/// Scenes of bodies in the same form.
pub fn assemblies() -> Vec<(String, AssemblyScene)> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(datasets("assemblies")).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    paths.sort();
    let name = |path: &PathBuf| path.file_stem().unwrap().to_string_lossy().into_owned();
    paths
        .iter()
        .map(|path| (name(path), AssemblyScene::read(path).unwrap_or_else(|fault| panic!("{path:?}: {fault}"))))
        .collect()
}

/// One scene of bodies.
pub fn assembly(name: &str) -> AssemblyScene {
    assemblies().into_iter().find(|(other, _)| other == name).map(|(_, scene)| scene).unwrap()
}

/// Solves a scene of bodies and keeps samples of its motion.
pub fn with_history(scene: &AssemblyScene) -> Simulation {
    let wanted = Wanted {
        intervals: MOST_INTERVALS,
        reliability: true,
        course: true,
        take: None,
        stop: &AtomicBool::new(false),
        tell: &mut |_| (),
    };
    scene.simulate_with(wanted).unwrap()
}

/// One scene of the gallery.
pub fn named(name: &str) -> Scene {
    gallery().into_iter().find(|(other, _)| other == name).map(|(_, scene)| scene).unwrap()
}

/// Its restitution.
pub fn restitution(scene: &Scene) -> f64 {
    scene.impact().unwrap().solve().unwrap().restitution.unwrap()
}

/// Compares a generated file with the one that is checked in; with `VIBROIMPACT_BLESS` set, writes it first.
pub fn assert_checked_in(path: &str, text: &str) {
    let path = datasets(path);
    if std::env::var_os("VIBROIMPACT_BLESS").is_some() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == text,
        "{} is out of date: run this test with VIBROIMPACT_BLESS=1 and look at the change",
        path.display()
    );
}
