//! Attachments, supports, axial force and foundation: closed forms, multiple precision, limits, metamorphic checks.

use crate::common::{ENDS, orthonormality_defect, rows, segment};
use beam_modes::{Attachment, Beam, BeamSystem, End, InvalidInput, Modes, Segment, ShearSection, Support};
use std::f64::consts::PI;

fn bare(segments: &[Segment], ends: [End; 2]) -> BeamSystem {
    BeamSystem::from(Beam { segments: segments.to_vec(), ends })
}

fn unit(ends: [End; 2]) -> BeamSystem {
    bare(&[segment(1.0, 1.0, 1.0)], ends)
}

/// A uniform Timoshenko beam of the same rigidity and mass.
fn thick(ends: [End; 2]) -> BeamSystem {
    let section = ShearSection { shear_rigidity_n: 400.0, rotary_inertia_kg_m: 1e-3 };
    BeamSystem { shear: Some(vec![section]), ..unit(ends) }
}

fn at(location_m: f64) -> Attachment {
    Attachment { location_m, ..Attachment::default() }
}

fn omega(system: &BeamSystem, count: usize) -> Vec<f64> {
    system.modes(count).unwrap().omega_rad_s().to_vec()
}

fn assert_close(ours: &[f64], theirs: &[f64], tolerance: f64) {
    assert_eq!(ours.len(), theirs.len());
    for (n, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
        assert!((ours - theirs).abs() <= tolerance * theirs.abs(), "mode {n}: {ours} {theirs}");
    }
}

#[test]
fn multiple_precision_reference() {
    let fittings = BeamSystem {
        shear: Some(
            [(400.0, 1e-3), (280.0, 4e-4)]
                .map(|(shear_rigidity_n, rotary_inertia_kg_m)| ShearSection { shear_rigidity_n, rotary_inertia_kg_m })
                .to_vec(),
        ),
        attachments: vec![Attachment {
            mass_kg: 0.2,
            rotary_inertia_kg_m2: 0.01,
            spring_n_m: 50.0,
            rotational_spring_n_m_rad: 3.0,
            ..at(0.3)
        }],
        supports: vec![Support { location_m: 0.75 }],
        ..bare(&[segment(0.75, 1.0, 1.0), segment(0.25, 0.4, 0.6)], [End::Free, End::Pinned])
    };
    let compressed = BeamSystem {
        attachments: vec![Attachment { mass_kg: 0.1, ..at(0.75) }],
        axial_force_n: -5.0,
        foundation_n_m2: 3000.0,
        ..bare(&[segment(0.5, 1.0, 1.0), segment(0.5, 0.3, 2.0)], [End::Clamped, End::Pinned])
    };
    let taut = BeamSystem {
        attachments: vec![Attachment { mass_kg: 0.5, rotary_inertia_kg_m2: 0.02, ..at(0.5) }],
        axial_force_n: 2000.0,
        ..bare(&[segment(0.5, 1.0, 1.0), segment(0.5, 0.3, 2.0)], [End::Pinned, End::Free])
    };
    for (name, system) in [("timoshenko fittings", fittings), ("compressed on foundation", compressed), ("taut", taut)]
    {
        let reference: Vec<f64> = rows(include_str!("data/beam_system_reference.csv"))
            .filter(|row| row[0] == name)
            .map(|row| row[2].parse().unwrap())
            .collect();
        assert!(reference.len() >= 16);
        assert_close(&omega(&system, reference.len()), &reference, 1e-11);
    }
}

/// The modes of a pinned beam under axial force and on a foundation are still sines.
#[test]
fn axial_force_and_foundation_of_a_pinned_beam() {
    for (force, foundation) in
        [(0.0, 1e3), (0.0, 1e9), (50.0, 0.0), (1e6, 0.0), (-9.0, 0.0), (-25.0, 4e3), (300.0, 1e5)]
    {
        let system = BeamSystem { axial_force_n: force, foundation_n_m2: foundation, ..unit([End::Pinned; 2]) };
        let exact: Vec<f64> =
            (1..=60).map(|n| (n as f64 * PI).powi(2)).map(|k2| (k2 * k2 + force * k2 + foundation).sqrt()).collect();
        let mut sorted = exact.clone();
        sorted.sort_by(f64::total_cmp);
        // Near buckling, small squares of frequencies are differences of large numbers.
        assert_close(&omega(&system, 60), &sorted, 1e-11);
        let x = 0.3;
        let sum: f64 = (1..200_000)
            .rev()
            .map(|n| n as f64 * PI)
            .map(|k| 2.0 * (k * x).sin().powi(2) / (k.powi(4) + force * k * k + foundation))
            .sum();
        let compliance = system.static_compliance(x).unwrap();
        assert!((compliance / sum - 1.0).abs() < 1e-10, "{force} {foundation}: {compliance} {sum}");
    }
}

/// On a foundation so stiff that the squares of all frequencies agree to eight digits, the modes of a pinned beam are still
/// sines, and those of a free one are a translation, a rotation and its modes without foundation.
#[test]
fn shapes_on_a_very_stiff_foundation() {
    let foundation_n_m2 = 1e10;
    for ends in [[End::Pinned; 2], [End::Free; 2]] {
        let modes = BeamSystem { foundation_n_m2, ..unit(ends) }.modes(20).unwrap();
        let bare = unit(ends).modes(20).unwrap();
        assert_eq!(modes.rigid_body_count(), 0);
        for (ours, own) in modes.omega_rad_s().iter().zip(bare.omega_rad_s()) {
            assert!((ours / (own * own + foundation_n_m2).sqrt() - 1.0).abs() < 1e-14, "{ours} {own}");
        }
        for x in [0.0, 0.013, 0.3, 0.81, 1.0] {
            for (n, (ours, own)) in modes.shapes_at(x).unwrap().iter().zip(bare.shapes_at(x).unwrap()).enumerate() {
                let sine = 2f64.sqrt() * (PI * (n + 1) as f64 * x).sin();
                let exact = if ends[0] == End::Pinned { sine } else { own };
                assert!((ours - exact).abs() < 1e-11, "{ends:?} {n} at {x}: {ours} {exact}");
            }
        }
    }
}

/// Where the mass per length changes, or a mass is attached, a stiff foundation lets waves decay in a part of the beam. The
/// reversed beam is the same one, and modes are orthonormal and add up to the static compliance.
#[test]
fn steps_and_masses_on_a_stiff_foundation() {
    let steps = [segment(0.3, 1.0, 1.0), segment(0.25, 0.5, 1.6), segment(0.45, 2.0, 0.7)];
    let mass = Attachment { mass_kg: 0.2, rotary_inertia_kg_m2: 1e-5, ..at(0.4) };
    for (left, right) in [(End::Pinned, End::Pinned), (End::Clamped, End::Free), (End::Free, End::Guided)] {
        for (attachments, axial_force_n) in [(vec![], 0.0), (vec![mass], 0.0), (vec![mass], 300.0), (vec![mass], -30.0)]
        {
            let supports = vec![Support { location_m: 0.75 }];
            let founded = BeamSystem { foundation_n_m2: 1e7, axial_force_n, ..bare(&steps, [left, right]) };
            let system = BeamSystem { attachments, supports, ..founded };
            let modes = system.modes(150).unwrap();
            assert_close(modes.omega_rad_s(), &omega(&turned(&system), 150), 1e-13);
            if system.attachments.is_empty() {
                // the support divides the last segment
                let along = [(0.3, 1.0, 600.0), (0.25, 1.6, 600.0), (0.2, 0.7, 600.0), (0.25, 0.7, 600.0)];
                let defect = orthonormality_defect(&along, &modes);
                assert!(defect < 1e-10, "{left:?} {right:?}: {defect:e}");
            }
            let (x, y) = (0.37, 0.41);
            let (green, size) = (system.static_green(x, y).unwrap(), system.static_compliance(x).unwrap());
            let error = sum_of_modes(&modes, x, y) - green;
            assert!(error.abs() < 1e-3 * size, "{left:?} {right:?} {axial_force_n}: {error:e} of {size:e}");
        }
    }
}

#[test]
fn buckling_is_refused_at_the_critical_load() {
    use End::{Clamped, Free, Guided, Pinned};
    for (ends, critical) in [
        ([Pinned, Pinned], PI.powi(2)),
        ([Clamped, Clamped], 4.0 * PI.powi(2)),
        ([Clamped, Free], PI.powi(2) / 4.0),
        ([Clamped, Guided], PI.powi(2)),
        ([Guided, Guided], PI.powi(2)),
        ([Pinned, Free], 0.0),
    ] {
        let under = |factor: f64| BeamSystem { axial_force_n: -factor * critical - 1e-3, ..unit(ends) }.modes(2);
        if critical > 0.0 {
            assert!(under(0.99).is_ok(), "{ends:?}");
        }
        let fault = under(1.001).unwrap_err();
        let named: f64 =
            fault.to_string().split("critical load ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        assert!(
            fault.field == "axial_force_n" && (named + critical).abs() < 1e-5 * (1.0 + critical),
            "{ends:?} {fault}"
        );
    }
}

/// A force keeps its direction: a free beam in tension rotates about its centre like a string.
#[test]
fn a_free_end_keeps_the_direction_of_the_force() {
    let system = BeamSystem { axial_force_n: 1e-4, ..unit([End::Free; 2]) };
    let modes = system.modes(3).unwrap();
    assert_eq!(modes.rigid_body_count(), 1);
    // Rotation of a stiff bar: inertia 1/12, restoring moment T L.
    assert!((modes.omega_rad_s()[1] / (12.0 * 1e-4f64).sqrt() - 1.0).abs() < 1e-5, "{:?}", modes.omega_rad_s());
}

/// A heavy attachment or a stiff spring is equivalent to a support; with rotary inertia too, to a clamp.
#[test]
fn heavy_attachments_and_stiff_springs_are_supports() {
    for base in [unit([End::Clamped, End::Free]), thick([End::Pinned, End::Free]), unit([End::Free; 2])] {
        let x = 0.62;
        let supported = BeamSystem { supports: vec![Support { location_m: x }], ..base.clone() };
        let sprung = BeamSystem { attachments: vec![Attachment { spring_n_m: 1e14, ..at(x) }], ..base.clone() };
        assert_close(&omega(&sprung, 12), &omega(&supported, 12), 1e-9);
        let heavy = BeamSystem { attachments: vec![Attachment { mass_kg: 1e12, ..at(x) }], ..base.clone() };
        let skipped = heavy.modes(14).unwrap();
        let slow = skipped.omega_rad_s().iter().filter(|&&omega| omega < 1e-3).count();
        let rigid = supported.rigid_body_count().unwrap();
        assert_close(&skipped.omega_rad_s()[slow..][..10], &omega(&supported, 12 + rigid)[rigid..][..10], 1e-9);
    }
}

/// An attachment or a support at an end is equivalent to an end of another kind.
#[test]
fn an_attachment_can_replace_an_end() {
    for base in [unit([End::Clamped, End::Free]), thick([End::Clamped, End::Free])] {
        let with = |attachment: Attachment| BeamSystem { attachments: vec![attachment], ..base.clone() };
        let ended =
            |end: End| BeamSystem { beam: Beam { ends: [End::Clamped, end], ..base.beam.clone() }, ..base.clone() };
        let pinned = omega(&ended(End::Pinned), 10);
        assert_close(&omega(&with(Attachment { spring_n_m: 1e14, ..at(1.0) }), 10), &pinned, 1e-9);
        let supported = BeamSystem { supports: vec![Support { location_m: 1.0 }], ..base.clone() };
        assert_close(&omega(&supported, 10), &pinned, 1e-13);
        let turned = with(Attachment { rotational_spring_n_m_rad: 1e14, ..at(1.0) });
        assert_close(&omega(&turned, 10), &omega(&ended(End::Guided), 10), 1e-9);
        let both = Attachment { spring_n_m: 1e14, rotational_spring_n_m_rad: 1e14, ..at(1.0) };
        assert_close(&omega(&with(both), 10), &omega(&ended(End::Clamped), 10), 1e-9);
    }
}

/// A mass on a cantilever of negligible weight, and a stiff bar on two soft springs.
#[test]
fn one_and_two_degrees_of_freedom() {
    let light =
        BeamSystem { attachments: vec![Attachment { mass_kg: 1e9, ..at(1.0) }], ..unit([End::Clamped, End::Free]) };
    assert!((omega(&light, 1)[0] / (3e-9f64).sqrt() - 1.0).abs() < 1e-9);
    let soft = BeamSystem {
        attachments: vec![Attachment { spring_n_m: 1e-8, ..at(0.0) }, Attachment { spring_n_m: 1e-8, ..at(1.0) }],
        ..unit([End::Free; 2])
    };
    let modes = soft.modes(3).unwrap();
    assert_eq!(modes.rigid_body_count(), 0);
    assert!((modes.omega_rad_s()[0] / (2e-8f64).sqrt() - 1.0).abs() < 1e-8, "{:?}", modes.omega_rad_s());
    assert!((modes.omega_rad_s()[1] / (6e-8f64).sqrt() - 1.0).abs() < 1e-8, "{:?}", modes.omega_rad_s());
}

fn turned(system: &BeamSystem) -> BeamSystem {
    let mut other = system.clone();
    let length_m = system.beam.length_m();
    other.beam.segments.reverse();
    other.beam.ends.reverse();
    if let Some(shear) = &mut other.shear {
        shear.reverse();
    }
    other.attachments.iter_mut().for_each(|a| a.location_m = length_m - a.location_m);
    other.supports.iter_mut().for_each(|s| s.location_m = length_m - s.location_m);
    other
}

fn sum_of_modes(modes: &Modes, x: f64, y: f64) -> f64 {
    let (u, v) = (modes.shapes_at(x).unwrap(), modes.shapes_at(y).unwrap());
    let first = modes.rigid_body_count();
    (first..modes.len()).map(|k| u[k] * v[k] / modes.omega_rad_s()[k].powi(2)).sum()
}

/// All options at once: the reversed beam is the same beam, its static compliance is the sum over its modes, and more mass
/// lowers, more stiffness raises every frequency.
#[test]
fn metamorphic_checks() {
    let section = |factor: f64| ShearSection { shear_rigidity_n: 400.0 * factor, rotary_inertia_kg_m: 1e-3 * factor };
    for (i, &left) in ENDS.iter().enumerate() {
        // The other pairs are the same reversed.
        for &right in &ENDS[i..] {
            let base = BeamSystem {
                attachments: vec![
                    Attachment { mass_kg: 0.3, rotary_inertia_kg_m2: 0.003, ..at(0.25) },
                    Attachment { spring_n_m: 30.0, mass_kg: 0.1, ..at(0.8) },
                ],
                ..bare(&[segment(0.45, 1.0, 1.0), segment(0.55, 0.6, 0.8)], [left, right])
            };
            let supported = BeamSystem { supports: vec![Support { location_m: 0.6 }], ..base.clone() };
            let sheared = BeamSystem { shear: Some(vec![section(1.0), section(0.7)]), ..base.clone() };
            let founded = BeamSystem { foundation_n_m2: 500.0, axial_force_n: 20.0, ..supported.clone() };
            for system in [&base, &supported, &sheared, &founded] {
                let modes = system.modes(250).unwrap();
                let other = turned(system).modes(250).unwrap();
                for (n, (a, b)) in modes.omega_rad_s().iter().zip(other.omega_rad_s()).enumerate() {
                    assert!((a - b).abs() <= 1e-11 * a, "{left:?} {right:?} {n}: {a} {b}");
                }
                let (x, y) = (0.15, 0.7);
                let (green, size) = (system.static_green(x, y).unwrap(), system.static_compliance(x).unwrap());
                let backwards = turned(system).static_green(1.0 - x, 1.0 - y).unwrap();
                assert!((green - backwards).abs() < 1e-12 * size);
                assert!((green - system.static_green(y, x).unwrap()).abs() < 1e-12 * size);
                let error = sum_of_modes(&modes, x, y) - green;
                assert!(error.abs() < 5e-4 * size, "{left:?} {right:?} {system:?}: {error:e} of {size:e}");

                let mut heavier = system.clone();
                heavier.attachments[0].mass_kg *= 2.0;
                let mut stiffer = system.clone();
                stiffer.attachments[1].spring_n_m *= 2.0;
                let (heavier, stiffer) = (omega(&heavier, 30), omega(&stiffer, 30));
                for k in 0..30 {
                    let own = modes.omega_rad_s()[k];
                    assert!(heavier[k] <= own * (1.0 + 1e-12) && stiffer[k] >= own * (1.0 - 1e-12));
                }
            }
        }
    }
}

/// A system without attachments gives the numbers of the beam alone, to the last bit.
#[test]
fn a_system_without_attachments_is_its_beam() {
    let system = bare(&[segment(0.45, 1.0, 1.0), segment(0.55, 0.6, 0.8)], [End::Clamped, End::Free]);
    assert_eq!(omega(&system, 50), system.beam.modes(50).unwrap().omega_rad_s());
    assert_eq!(system.static_green(0.2, 0.7), system.beam.static_green(0.2, 0.7));
    let empty = BeamSystem { attachments: vec![at(0.3)], ..system.clone() };
    assert_close(&omega(&empty, 50), &omega(&system, 50), 1e-13);
    for x in [0.1, 0.7, 1.0] {
        let [ours, theirs] = [&empty, &system].map(|s| s.static_compliance(x).unwrap());
        assert!((ours / theirs - 1.0).abs() < 1e-12, "{ours} {theirs}");
    }
}

/// The squares of the participations in a uniform acceleration add up to the mass, attachments included.
#[test]
fn all_the_mass_takes_part_in_a_uniform_acceleration() {
    for base in [unit([End::Free; 2]), thick([End::Free, End::Guided])] {
        let system = BeamSystem { attachments: vec![Attachment { mass_kg: 0.7, ..at(0.3) }], ..base };
        let squares = |count| {
            let participation = system.modes(count).unwrap().participation_kg0_5();
            participation.iter().map(|p| p * p).sum::<f64>()
        };
        assert!((squares(2) - 1.7).abs() < 1e-12 && (squares(30) - 1.7).abs() < 1e-12, "{}", squares(30));
    }
    let clamped = BeamSystem { attachments: vec![Attachment { mass_kg: 0.7, ..at(0.3) }], ..thick([End::Clamped; 2]) };
    let squares: f64 = clamped.modes(600).unwrap().participation_kg0_5().iter().map(|p| p * p).sum();
    assert!(squares < 1.7 && squares > 1.695, "{squares}");
}

#[test]
fn bad_input_is_named() {
    let field = |change: &dyn Fn(&mut BeamSystem)| -> String {
        let mut system = unit([End::Clamped, End::Free]);
        change(&mut system);
        let fault: InvalidInput = system.modes(3).unwrap_err();
        assert_eq!(system.static_compliance(0.5).unwrap_err().field, fault.field);
        fault.field.to_string()
    };
    for bad in [-1e-9, 1.0 + 1e-9, f64::NAN, f64::INFINITY] {
        assert_eq!(field(&|s| s.attachments.push(at(bad))), "attachments[0].location_m");
        assert_eq!(field(&|s| s.supports.push(Support { location_m: bad })), "supports[0].location_m");
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY, 1e300] {
        let put = |set: fn(&mut Attachment, f64)| {
            field(&|s| {
                let mut attachment = at(0.5);
                set(&mut attachment, bad);
                s.attachments.push(attachment);
            })
        };
        assert_eq!(put(|a, v| a.mass_kg = v), "attachments[0].mass_kg");
        assert_eq!(put(|a, v| a.rotary_inertia_kg_m2 = v), "attachments[0].rotary_inertia_kg_m2");
        assert_eq!(put(|a, v| a.spring_n_m = v), "attachments[0].spring_n_m");
        assert_eq!(put(|a, v| a.rotational_spring_n_m_rad = v), "attachments[0].rotational_spring_n_m_rad");
        assert_eq!(field(&|s| s.foundation_n_m2 = bad), "foundation_n_m2");
    }
    for bad in [f64::NAN, f64::INFINITY, 1e300, -1e300] {
        assert_eq!(field(&|s| s.axial_force_n = bad), "axial_force_n");
    }
    assert_eq!(field(&|s| s.foundation_n_m2 = 1e17), "foundation_n_m2");
}

/// Between the ends, where neither a support nor an end is a node of the solver's own spans.
#[test]
fn nothing_moves_at_a_support() {
    for (x, axial_force_n) in [(0.3, 0.0), (1.0 / 3.0, 400.0), (0.77, 0.0), (1.0, 0.0)] {
        let system = BeamSystem {
            supports: vec![Support { location_m: x }],
            axial_force_n,
            ..bare(&[segment(0.6, 1.0, 1.0), segment(0.4, 2.0, 1.0)], [End::Clamped, End::Free])
        };
        let modes = system.modes(12).unwrap();
        assert_eq!(modes.shapes_at(x).unwrap(), vec![0.0; 12], "{x}");
        let beside = modes.shapes_at(x - 1e-9).unwrap();
        assert!(beside.iter().any(|shape| shape.abs() > 1e-9), "{x}: {beside:?}");
    }
}
