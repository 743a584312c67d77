//! How long the 15 runs of the drop study's design take on one core, and one set of
//! features with derivatives:
//!
//!     cargo run --release -p windfall-identify --example design_speed

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::time::Instant;
use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_drop_rig::coordinates::law_coordinates;
use windfall_drop_rig::measured::{
    DropFeature, FeatureKind, RigQuantity, feature_sensitivity, feature_values,
};
use windfall_drop_rig::rig::{DropRig, Plate};

const REPEATS: u32 = 50;

fn main() {
    let start = r#"adams-impact(k="0.65 N/mm^2.25", e=2.25, c="3.5e-4 N s/mm", d="0.001 mm")"#;
    let start = parse_law(start).unwrap().complete().unwrap();
    let coordinates = law_coordinates(&start, &[0, 1, 2], 1e-3).unwrap();
    let alpha = 8f64.powf(0.25);
    let mut points: Vec<[f64; 3]> = vec![[0.0; 3]];
    for axis in 0..3 {
        for side in [-alpha, alpha] {
            let mut point = [0.0; 3];
            point[axis] = side;
            points.push(point);
        }
    }
    for corner in 0..8 {
        points.push([0, 1, 2].map(|bit| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 }));
    }
    let features = [FeatureKind::PeakSupportForce, FeatureKind::Interval]
        .map(|kind| DropFeature { kind, impact: 0 });
    let plate = Plate {
        mass: 0.2,
        stiffness: 645_800.0,
        damping: 52.47,
    };
    for (name, plate) in [("rigid", None), ("sprung", Some(plate))] {
        let rig = DropRig {
            mass: 0.0048,
            effective_mass_factor: 1.0,
            gravity: 9.80665,
            plate,
        };
        let clock = Instant::now();
        for _ in 0..REPEATS {
            for point in &points {
                let k = 0.65 + 0.208_111_245_125_476_19 * point[0];
                let e = 2.25 + 0.445_952_668_126_020_4 * point[1];
                let c = 0.35 + 0.148_650_889_375_340_15 * point[2];
                let law = coordinates.law_at(&[k.ln(), e, c.ln()]).unwrap();
                feature_values(&law, &rig, 0.5, &features, EndRule::ForceZero).unwrap();
            }
        }
        let design = clock.elapsed() / REPEATS;
        let clock = Instant::now();
        for _ in 0..REPEATS {
            let wanted = (
                &[0, 1, 2][..],
                &[RigQuantity::Mass, RigQuantity::Height][..],
            );
            feature_sensitivity(&start, &rig, 0.5, &features, EndRule::ForceZero, wanted).unwrap();
        }
        let one = clock.elapsed() / REPEATS;
        println!(
            "{name} plate: {} runs {design:?}; one drop with derivatives {one:?}",
            points.len()
        );
    }
}
