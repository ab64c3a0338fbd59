//! The beam, its impacts resolved in full, and the law fitted to a few of them before the game starts.

use vibroimpact::emoc::{Impact, Parameters, Site};
use vibroimpact::net::{Datum, law};
use vibroimpact::{Scene, SceneError};

/// The uniform pinned beam of thesis chapter 4 and a ball of 33 mm.
const SCENE: &str = r#"{
    "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02,
        "segments": [{ "length_m": 1, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800,
                       "width_m": 0.011323, "thickness_m": 0.011323 }] },
    "striker": { "density_kg_m3": 7800, "radius_m": 0.0165, "speed_m_s": 1 },
    "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 },
    "location_m": 0.4, "modes": 100, "residual_compliance": true
}"#;
/// Modes in the law.
const MODES: usize = 50;
/// Entries of the table of places that the game looks up.
const TABLE: usize = 400;

pub struct Beam {
    scene: Scene,
    pub length_m: f64,
    pub ball_radius_m: f64,
    pub ball_mass_kg: f64,
    parameters: Parameters,
    /// What the law needs of each place, evenly spaced from end to end.
    sites: Vec<Site>,
}

impl Beam {
    /// Resolves impacts at thirty places and fits the law's three parameters to them.
    pub fn new() -> Result<Beam, SceneError> {
        let scene = Scene::from_json(SCENE)?;
        let ball_mass_kg = scene.impact()?.striker.mass_kg;
        let at = |x: f64| Scene { location_m: Some(x), ..scene.clone() };
        let mut seen = Vec::new();
        for i in 1..=30 {
            let location_m = i as f64 / 31.0;
            if let Some(restitution) = at(location_m).impact()?.solve()?.restitution {
                seen.push(Datum { line: i, mass_kg: ball_mass_kg, location_m, restitution });
            }
        }
        let fit = scene.observations(&seen, MODES)?.fit().expect("thirty impacts determine three parameters");
        let site = |i: usize| {
            let shapes: Vec<f64> = at(i as f64 / TABLE as f64).mode_shapes(MODES)?.iter().map(|mode| mode.shape).collect();
            Ok(Site::new(&shapes).map_err(vibroimpact::InvalidInput::from)?)
        };
        let sites = (0..=TABLE).map(site).collect::<Result<_, SceneError>>()?;
        Ok(Beam { scene, length_m: 1.0, ball_radius_m: 0.0165, ball_mass_kg, parameters: law(&fit.parameters), sites })
    }

    /// Restitution at a place by the law: a look-up and a closed form.
    pub fn restitution(&self, x_m: f64) -> f64 {
        let nearest = (x_m / self.length_m * TABLE as f64).round().clamp(0.0, TABLE as f64) as usize;
        let impact = Impact::new(self.ball_mass_kg, &self.sites[nearest]);
        impact.and_then(|impact| self.parameters.rebound(&impact)).map_or(0.0, |rebound| rebound.restitution)
    }

    /// Restitution at a place with every contact resolved.
    pub fn resolved(&self, x_m: f64) -> Result<f64, SceneError> {
        let scene = Scene { location_m: Some(x_m), ..self.scene.clone() };
        Ok(scene.impact()?.solve()?.restitution.unwrap_or(f64::NAN))
    }
}
