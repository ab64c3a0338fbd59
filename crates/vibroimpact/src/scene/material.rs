//! Materials by name.
//!
//! An object of a scene that takes numbers of a material may name one instead: `"material": "steel"` in a segment, a
//! plate, an infinite structure, a dropped rod, a striker (its density) or a contact (where `"striker_material"` is that
//! of the striker). A number that is stated in addition takes precedence over the material's. The names are replaced by
//! their numbers before a scene is read, so that a result shows the numbers with which it was computed.

use std::borrow::Cow;

use invalid_input::InvalidInput;
use serde_json::{Map, Value};

use super::told::{did_you_mean, quote};

/// Typical values of an elastic, isotropic material from a standard or a handbook.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedMaterial {
    /// Its name in a scene.
    pub name: &'static str,
    /// Young's modulus (Pa).
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Density (kg/m^3).
    pub density_kg_m3: f64,
    /// Source of the numbers.
    pub source: &'static str,
}

/// The materials that a scene may name.
///
/// ```
/// use vibroimpact::scene::MATERIALS;
///
/// let steel = MATERIALS.iter().find(|material| material.name == "steel").unwrap();
/// assert_eq!((steel.youngs_modulus_pa, steel.density_kg_m3), (2.1e11, 7850.0));
/// ```
pub const MATERIALS: [NamedMaterial; 5] = [
    NamedMaterial {
        name: "steel",
        youngs_modulus_pa: 2.1e11,
        poissons_ratio: 0.3,
        density_kg_m3: 7850.0,
        source: "structural steel: EN 1993-1-1, 3.2.6, and EN 1993-1-2, 3.2.2",
    },
    NamedMaterial {
        name: "aluminium",
        youngs_modulus_pa: 7e10,
        poissons_ratio: 0.3,
        density_kg_m3: 2700.0,
        source: "structural alloys: EN 1999-1-1, 3.2.5",
    },
    NamedMaterial {
        name: "glass",
        youngs_modulus_pa: 7e10,
        poissons_ratio: 0.2,
        density_kg_m3: 2500.0,
        source: "soda-lime glass: EN 572-1",
    },
    NamedMaterial {
        name: "rubber",
        youngs_modulus_pa: 2.2e6,
        poissons_ratio: 0.4996,
        density_kg_m3: 1100.0,
        source: "natural rubber of 50 IRHD, small strains: P. B. Lindley, Engineering Design with Natural Rubber, whose \
                 bulk modulus of 1030 MPa gives Poisson's ratio; density of a compound filled with carbon black",
    },
    NamedMaterial {
        name: "wood",
        youngs_modulus_pa: 1.1e10,
        poissons_ratio: 0.37,
        density_kg_m3: 420.0,
        source: "softwood C24 along the grain: EN 338; Poisson's ratio of Sitka spruce: Wood Handbook, FPL-GTR-282, \
                 chapter 5",
    },
];

pub(super) const MATERIAL: &str = "material";
const STRIKER_MATERIAL: &str = "striker_material";
const MODULUS: &str = "youngs_modulus_pa";
const RATIO: &str = "poissons_ratio";
const DENSITY: &str = "density_kg_m3";
/// The numbers of a material.
pub(super) const NUMBERS: [&str; 3] = [MODULUS, RATIO, DENSITY];
/// Fields that state stiffness and mass in another way, with which a material cannot be combined.
const IN_ITS_PLACE: [&str; 7] = [
    "flexural_rigidity_n_m2",
    "axial_rigidity_n",
    "mass_kg",
    "stiffness_n_m1_5",
    "stiffness_n_m",
    "stiffness_n_m_n",
    "effective_modulus_pa",
];

/// The fields that name a material in an object which has these fields.
pub(super) fn names_beside(known: &[&str]) -> Vec<&'static str> {
    let has = |name: &str| known.contains(&name);
    let material = has(MODULUS) || has(DENSITY);
    let striker = has("striker_youngs_modulus_pa");
    [(MATERIAL, material), (STRIKER_MATERIAL, striker)]
        .into_iter()
        .filter_map(|(name, here)| (here && !known.contains(&name)).then_some(name))
        .collect()
}

/// The scene with the names of its materials replaced by their numbers.
///
/// # Errors
/// An unknown material, or a material together with a field that states the same property in another way.
pub(crate) fn numbers_of_materials(scene: &Value) -> Result<Cow<'_, Value>, InvalidInput> {
    if !names_one(scene) {
        return Ok(Cow::Borrowed(scene));
    }
    let mut written_out = scene.clone();
    replace(&mut written_out, Holder::Scene)?;
    Ok(Cow::Owned(written_out))
}

/// The objects that may name a material, and the objects that contain them.
#[derive(Clone, Copy, PartialEq)]
enum Holder {
    Scene,
    Bodies,
    /// A structure, or a body.
    Structure,
    Segment,
    /// A segment of a rod in axial vibration, which does not need Poisson's ratio.
    RodSegment,
    Striker,
    Contact,
}

impl Holder {
    /// The value of a key.
    fn under(self, key: &str, of_rod: bool) -> Option<Holder> {
        Some(match (self, key) {
            (Holder::Scene, "structure") | (Holder::Bodies, _) => Holder::Structure,
            (Holder::Scene, "striker") => Holder::Striker,
            (Holder::Scene, "contact" | "contacts") => Holder::Contact,
            (Holder::Scene, "bodies") => Holder::Bodies,
            (Holder::Structure, "segments") if of_rod => Holder::RodSegment,
            (Holder::Structure, "segments") => Holder::Segment,
            _ => return None,
        })
    }

    /// The numbers of a material that this object needs.
    fn takes(self, kind: Option<&str>) -> &'static [&'static str] {
        match (self, kind) {
            (Holder::Structure, Some("plate" | "infinite-beam" | "infinite-plate" | "dropped-rod"))
            | (Holder::Segment, _) => &NUMBERS,
            (Holder::RodSegment, _) => &[MODULUS, DENSITY],
            (Holder::Striker, _) => &[DENSITY],
            (Holder::Contact, _) => &[MODULUS, RATIO],
            _ => &[],
        }
    }
}

/// Whether any object names a material.
fn names_one(value: &Value) -> bool {
    match value {
        Value::Object(map) => {
            map.contains_key(MATERIAL) || map.contains_key(STRIKER_MATERIAL) || map.values().any(names_one)
        }
        // lists of numbers, which may be long, are skipped after their first item
        Value::Array(items) => items.iter().take_while(|item| !item.is_number()).any(names_one),
        _ => false,
    }
}

fn replace(value: &mut Value, holder: Holder) -> Result<(), InvalidInput> {
    match value {
        Value::Array(items) => {
            items.iter_mut().enumerate().try_for_each(|(i, item)| replace(item, holder).map_err(|fault| fault.at(i)))
        }
        Value::Object(map) => {
            let kind = map.get("kind").and_then(Value::as_str).map(str::to_owned);
            for (key, inner) in map.iter_mut() {
                if let Some(under) = holder.under(key, kind.as_deref() == Some("rod")) {
                    replace(inner, under).map_err(|fault| fault.within(key.as_str()))?;
                }
            }
            let takes = holder.takes(kind.as_deref());
            if !takes.is_empty() {
                put_numbers(map, MATERIAL, takes, "")?;
            }
            if holder == Holder::Contact {
                put_numbers(map, STRIKER_MATERIAL, takes, "striker_")?;
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// Replaces the name of a material by its numbers, under their names after `prefix`, where they are not stated.
fn put_numbers(map: &mut Map<String, Value>, field: &str, takes: &[&str], prefix: &str) -> Result<(), InvalidInput> {
    let Some(named) = map.remove(field).filter(|named| !named.is_null()) else { return Ok(()) };
    if let Some(other) = IN_ITS_PLACE.iter().find(|other| map.get(**other).is_some_and(|value| !value.is_null())) {
        return Err(InvalidInput::new(field, quote(&named), format!("left out in the presence of {other}")));
    }
    let names = MATERIALS.map(|material| material.name);
    let material = MATERIALS.iter().find(|material| named == material.name).ok_or_else(|| {
        let meant = named.as_str().map_or_else(String::new, |word| did_you_mean(word, names));
        InvalidInput::new(field, quote(&named), format!("one of {}{meant}", names.join(", ")))
    })?;
    for (number, value) in
        [(MODULUS, material.youngs_modulus_pa), (RATIO, material.poissons_ratio), (DENSITY, material.density_kg_m3)]
    {
        if takes.contains(&number) {
            let place = map.entry(format!("{prefix}{number}")).or_insert(Value::Null);
            if place.is_null() {
                *place = value.into();
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn names_become_numbers_and_stated_numbers_stay() {
        let scene = json!({
            "structure": { "kind": "beam", "segments": [{ "length_m": 1, "material": "steel", "density_kg_m3": 7800 }] },
            "striker": { "material": "rubber", "radius_m": 0.01 },
            "contact": { "law": "hertz", "material": "steel", "striker_material": "rubber" }
        });
        let written_out = json!({
            "structure": { "kind": "beam", "segments": [{
                "length_m": 1, "youngs_modulus_pa": 2.1e11, "poissons_ratio": 0.3, "density_kg_m3": 7800 }] },
            "striker": { "density_kg_m3": 1100.0, "radius_m": 0.01 },
            "contact": { "law": "hertz", "youngs_modulus_pa": 2.1e11, "poissons_ratio": 0.3,
                         "striker_youngs_modulus_pa": 2.2e6, "striker_poissons_ratio": 0.4996 }
        });
        assert_eq!(*numbers_of_materials(&scene).unwrap(), written_out);
    }

    #[test]
    fn bodies_take_what_their_kind_has() {
        let scene = json!({
            "bodies": {
                "striker": { "kind": "rod", "segments": [{ "material": "glass" }] },
                "lid": { "kind": "plate", "material": "wood" }
            },
            "contacts": [{ "law": "hertz", "material": "glass" }]
        });
        let written_out = numbers_of_materials(&scene).unwrap();
        assert_eq!(
            written_out["bodies"]["striker"]["segments"][0],
            json!({ "youngs_modulus_pa": 7e10, "density_kg_m3": 2500.0 })
        );
        assert_eq!(written_out["bodies"]["lid"]["poissons_ratio"], 0.37);
        assert_eq!(written_out["contacts"][0]["youngs_modulus_pa"], 7e10);
    }

    #[test]
    fn what_cannot_be_used_is_named() {
        let told = |scene: Value| numbers_of_materials(&scene).unwrap_err().to_string();
        assert_eq!(
            told(json!({ "structure": { "kind": "beam", "segments": [{ "material": "stele" }] } })),
            "structure.segments[0].material = \"stele\" is not allowed; it must be one of steel, aluminium, glass, rubber, wood; \
             did you mean steel?"
        );
        assert_eq!(
            told(json!({ "striker": { "material": "steel", "mass_kg": 1 } })),
            "striker.material = \"steel\" is not allowed; it must be left out in the presence of mass_kg"
        );
        assert!(
            told(json!({ "contact": { "material": 7 } }))
                .starts_with("contact.material = 7 is not allowed; it must be one of")
        );
    }
}
