//! `windfall simulate drop`: a body whose contact is not below its centre of
//! mass.

use clap::Args;

/// Outline, inertia and friction of the body; a central impact where none is
/// given.
#[derive(Debug, Args)]
#[command(next_help_heading = "Eccentric contact (central if left out)")]
pub struct EccentricArguments {
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
