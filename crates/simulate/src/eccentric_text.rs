//! Simulated drops of planar bodies and their motions as text, CSV and JSON.

use crate::drop_text::{given, impact_csv, impact_table, plate_text, rows_of};
use crate::eccentric::{BodyOutcome, SimulatedEccentricDrop};
use crate::motion::{MotionOutcome, MovingBody};
use crate::text::{Column, Row, motion_csv, rows, samples};
use windfall_drop_rig::eccentric::impact::EccentricImpact;
use windfall_drop_rig::eccentric::simulate::EccentricTrajectory;
use windfall_files::error::Error;

fn eccentric_rows(own: &EccentricImpact) -> Vec<Row> {
    let mut out = rows_of(&own.impact);
    out.extend(rows![of own:
        rotation "rad",
        lever_arm "m",
        effective_mass_factor "1",
        angular_velocity_before "rad/s",
        angular_velocity "rad/s",
        tangential_velocity_before "m/s",
        tangential_velocity "m/s",
        friction_impulse "N s",
        translation_energy_before "J",
        rotation_energy_before "J",
        translation_energy "J",
        rotation_energy "J",
        contact_energy "J",
        sliding_energy "J",
        support_energy "J",
    ]);
    out
}

fn columns(drop: &SimulatedEccentricDrop) -> Vec<Vec<Row>> {
    drop.impacts.iter().map(eccentric_rows).collect()
}

/// A simulated drop of a planar body as text: a column for each impact.
pub fn text_of_eccentric_drop(drop: &SimulatedEccentricDrop) -> String {
    let rest = match drop.at_rest {
        true => "\nThe fruit then stays on the plate.\n",
        false => "",
    };
    format!(
        "simulated: {}, contact ends at {}\n{} of {} kg, from {} m under {} m/s^2; {}\n\
         moment of inertia {} kg m^2, friction {}; at release the contact would feel {} of the \
         mass\n\n{}\n{rest}",
        drop.law,
        drop.end,
        shape_text(&drop.body),
        given(drop.mass),
        given(drop.height),
        given(drop.gravity),
        plate_text(drop.plate.as_ref()),
        given(drop.body.inertia),
        given(drop.body.friction),
        given(drop.effective_mass_factor),
        impact_table(&columns(drop), &drop.intervals)
    )
}

fn shape_text(body: &BodyOutcome) -> String {
    let angle = given(body.angle.to_degrees());
    match (body.radius, body.offset, body.semi_axes) {
        (Some(radius), Some(offset), _) => format!(
            "ball of radius {} m, centre of mass {} m off the centre at {angle}° from straight down,",
            given(radius),
            given(offset)
        ),
        (_, _, Some([a, b])) => format!(
            "ellipse of semi-axes {} m and {} m, tilted by {angle}°,",
            given(a),
            given(b)
        ),
        _ => "body".to_owned(),
    }
}

/// A simulated drop of a planar body as CSV, one row per impact, units in the
/// header.
pub fn csv_of_eccentric_drop(drop: &SimulatedEccentricDrop) -> Result<String, Error> {
    impact_csv(&columns(drop), &drop.intervals)
}

fn motion_columns(motion: &EccentricTrajectory) -> [Column<'_>; 12] {
    [
        ("time", "s", &motion.times),
        ("contact_force", "N", &motion.contact_force),
        ("friction_force", "N", &motion.friction_force),
        ("support_force", "N", &motion.support_force),
        ("height_of_centre_of_mass", "m", &motion.height),
        ("velocity", "m/s", &motion.velocity),
        ("rotation", "rad", &motion.rotation),
        ("angular_velocity", "rad/s", &motion.angular_velocity),
        (
            "tangential_displacement",
            "m",
            &motion.tangential_displacement,
        ),
        ("tangential_velocity", "m/s", &motion.tangential_velocity),
        ("plate_displacement", "m", &motion.plate_displacement),
        ("plate_velocity", "m/s", &motion.plate_velocity),
    ]
}

/// The motion of a planar body as CSV; blank after it has come to stay.
pub fn csv_of_eccentric_motion(motion: &EccentricTrajectory) -> Result<String, Error> {
    motion_csv(&motion_columns(motion))
}

/// A drop and its motion as JSON shows them: the keys of the drop, and `motion`.
pub fn outcome_of_eccentric_motion(
    drop: &SimulatedEccentricDrop,
    motion: &EccentricTrajectory,
) -> MotionOutcome {
    MotionOutcome::Body(MovingBody {
        drop: drop.clone(),
        motion: samples(&motion_columns(motion)),
    })
}
