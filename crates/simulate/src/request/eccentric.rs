//! A planar body as it is asked for: texts with units → SI.

use windfall_drop_rig::eccentric::body::EccentricBody;
use windfall_drop_rig::eccentric::shape::Shape;
use windfall_files::error::Error;
use windfall_files::option_value::{at_least_zero, positive, quantity, unusable};

/// A body whose contact is not below its centre of mass; texts with units.
#[derive(Clone, Debug)]
pub struct EccentricRequest {
    /// Distance of the centre of mass from the centre of a disc.
    pub offset: Option<String>,
    /// Radius of the disc.
    pub radius: Option<String>,
    /// Direction from its centre to the centre of mass, from straight down.
    pub offset_angle: String,
    /// Semi-axes of an ellipse, with a comma between them.
    pub semi_axes: Option<String>,
    /// From the horizontal to its first axis.
    pub tilt: String,
    /// Moment of inertia about the centre of mass; that of a solid if left out.
    pub inertia: Option<String>,
    /// Coulomb's coefficient; 1.
    pub friction: f64,
    /// Angular velocity at release.
    pub angular_velocity: String,
    /// Horizontal velocity at release.
    pub tangential_velocity: String,
}

/// Reads the request for a planar body of `mass` (kg).
///
/// # Errors
/// An option cannot be read, or disc and ellipse are given in part or both.
pub fn eccentric_body(request: &EccentricRequest, mass: f64) -> Result<EccentricBody, Error> {
    let inertia = request.inertia.as_ref();
    let inertia = inertia.map(|text| positive("--inertia", text, "kg m^2"));
    if !(request.friction.is_finite() && request.friction >= 0.0) {
        return Err(unusable("--friction", "expected a number of zero or above"));
    }
    Ok(EccentricBody {
        shape: shape(request)?,
        mass,
        inertia: inertia.transpose()?,
        friction: request.friction,
        angular_velocity: quantity("--spin", &request.angular_velocity, "rad/s")?,
        tangential_velocity: quantity(
            "--tangential-velocity",
            &request.tangential_velocity,
            "m/s",
        )?,
    })
}

fn shape(request: &EccentricRequest) -> Result<Shape, Error> {
    match (&request.offset, &request.radius, &request.semi_axes) {
        (Some(offset), Some(radius), None) => Ok(Shape::OffsetDisc {
            radius: positive("--radius", radius, "m")?,
            offset: at_least_zero("--offset", offset, "m")?,
            angle: quantity("--offset-angle", &request.offset_angle, "rad")?,
        }),
        (None, None, Some(semi_axes)) => Ok(Shape::Ellipse {
            semi_axes: two_lengths(semi_axes)?,
            tilt: quantity("--tilt", &request.tilt, "rad")?,
        }),
        _ => Err(unusable(
            "--offset, --radius, --semi-axes",
            "expected --offset and --radius for a ball whose centre of mass is not its centre, \
             or --semi-axes for an ellipse",
        )),
    }
}

/// "12 mm,9 mm".
fn two_lengths(text: &str) -> Result<[f64; 2], Error> {
    let lengths = text.split(',').map(str::trim);
    let lengths = lengths.map(|length| positive("--semi-axes", length, "m"));
    let lengths = lengths.collect::<Result<Vec<_>, _>>()?;
    <[f64; 2]>::try_from(lengths).map_err(|found| {
        let problem = format!(
            "\"{text}\" has {} lengths; expected two, such as \"12 mm,9 mm\"",
            found.len()
        );
        unusable("--semi-axes", problem)
    })
}
