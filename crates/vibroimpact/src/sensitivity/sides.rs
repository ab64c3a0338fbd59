//! The sides of a beam's corners on which its points lie.
//!
//! At the end of a segment, at an attachment and at a support the curvature of the modes may jump, or the derivative of it, or by
//! Timoshenko's theory the slope of their deflection. The polynomial through neighbours on both sides would not have their slope.

use std::cmp::Ordering;

use serde_json::Value;

use crate::assembly::{AssemblyScene, Body, Elastics, Side};
use crate::scene::{Beam, Scene, Structure};

/// Of the struck point of the scene with this tree.
pub(super) fn of_tree(tree: &Value) -> Vec<Ordering> {
    let Ok(scene) = Scene::from_value(tree) else { return Vec::new() };
    let along = scene.location_m.and_then(|location| location.along().ok());
    match (&scene.structure, along) {
        (Structure::Beam(beam), Some(place_m)) => of_point(beam, place_m).collect(),
        _ => Vec::new(),
    }
}

/// Of the points of contacts and loads of the scene of bodies with this tree.
pub(super) fn of_tree_of_bodies(tree: &Value) -> Vec<Ordering> {
    let Ok(scene) = AssemblyScene::from_value(tree) else { return Vec::new() };
    let sides = scene.contacts.iter().flat_map(|contact| &contact.between).filter_map(|side| match side {
        Side::Ground(_) => None,
        Side::Body(point) => Some((&point.body, point.location_m)),
    });
    let points = sides.chain(scene.loads.iter().map(|load| (&load.body, load.location_m)));
    let of = |(name, location): (&String, Option<crate::scene::Location>)| {
        let Some(Body::Elastic(body)) = scene.bodies.get(name) else { return Vec::new() };
        match (&body.structure, location.and_then(|location| location.along().ok())) {
            (Elastics::Structure(Structure::Beam(beam)), Some(place_m)) => of_point(beam, place_m).collect(),
            _ => Vec::new(),
        }
    };
    points.flat_map(of).collect()
}

fn of_point(beam: &Beam, place_m: f64) -> impl Iterator<Item = Ordering> {
    beam.corners_m().into_iter().map(move |corner_m| place_m.total_cmp(&corner_m))
}

/// Whether all points stay on one side of each corner, on which a point itself may lie.
pub(super) fn stay(here: &[Ordering], neighbours: &[Vec<Ordering>]) -> bool {
    here.iter().enumerate().all(|(i, side)| {
        let sides = neighbours.iter().filter_map(|near| near.get(i)).chain([side]);
        let mut off = sides.filter(|side| **side != Ordering::Equal);
        let first = off.next();
        off.all(|side| Some(side) == first)
    })
}
