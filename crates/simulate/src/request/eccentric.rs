//! A planar body: options with units → SI.

use clap::Args;
use windfall_drop_rig::eccentric::body::EccentricBody;
use windfall_drop_rig::eccentric::shape::Shape;
use windfall_files::error::Error;
use windfall_files::option_value::{at_least_zero, positive, quantity, unusable};

/// A body whose contact is not below its centre of mass; a central impact where neither
/// offset nor semi-axes are given. Texts with units.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Eccentric contact (central if left out)")]
pub struct EccentricRequest {
    /// Distance of the centre of mass from the centre of the fruit, such as "3.8 mm"; with --radius
    #[arg(
        long,
        value_name = "QUANTITY",
        requires = "radius",
        conflicts_with = "semi_axes"
    )]
    pub offset: Option<String>,
    /// Radius of the fruit
    #[arg(long, value_name = "QUANTITY", requires = "offset")]
    pub radius: Option<String>,
    /// Direction of the offset at release, from straight down
    #[arg(
        long,
        default_value = "90 deg",
        value_name = "QUANTITY",
        allow_hyphen_values = true
    )]
    pub offset_angle: String,
    /// Semi-axes of an ellipse instead, such as "12 mm,9 mm"
    #[arg(long, value_name = "QUANTITY,QUANTITY")]
    pub semi_axes: Option<String>,
    /// Tilt of its first axis at release, from the horizontal
    #[arg(
        long,
        default_value = "0 deg",
        value_name = "QUANTITY",
        allow_hyphen_values = true
    )]
    pub tilt: String,
    /// Moment of inertia about the centre of mass, such as "1.92e-7 kg m^2"; that of a solid ball
    /// or ellipsoid if left out
    #[arg(long, value_name = "QUANTITY")]
    pub inertia: Option<String>,
    /// Coefficient of friction between fruit and plate
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "NUMBER",
        allow_hyphen_values = true
    )]
    pub friction: f64,
    /// Angular velocity at release, anticlockwise
    #[arg(
        long,
        default_value = "0 rad/s",
        value_name = "QUANTITY",
        allow_hyphen_values = true
    )]
    pub spin: String,
    /// Horizontal velocity at release
    #[arg(
        long,
        default_value = "0 m/s",
        value_name = "QUANTITY",
        allow_hyphen_values = true
    )]
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
        angular_velocity: quantity("--spin", &request.spin, "rad/s")?,
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
