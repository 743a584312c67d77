//! Outline of a planar body: its lowest point for every rotation.
//!
//! With H(φ) the depth of the lowest point below the centre of mass (the
//! support function of the outline towards the plate), the lowest point stands
//! at (−H′(φ), −H(φ)) from the centre of mass, whatever the outline.

/// Outline of the body and its attitude at release.
///
/// Angles turn anticlockwise; the plate is horizontal and below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A disc (a sphere seen from the side) whose centre of mass is not its
    /// geometric centre. H = R − ε cos φ.
    OffsetDisc {
        /// R, radius; m.
        radius: f64,
        /// ε, distance of the centre of mass from the geometric centre; m.
        offset: f64,
        /// φ at release, direction from the geometric centre to the centre of
        /// mass, from straight down: at π/2 it lies to the right and the lever
        /// arm is the whole offset; rad.
        angle: f64,
    },
    /// An ellipse (an ellipsoid seen along its third axis) with the centre of
    /// mass in its centre. H = √(a² sin² φ + b² cos² φ).
    Ellipse {
        /// a and b; m.
        semi_axes: [f64; 2],
        /// φ at release, from the horizontal to the axis of a; rad.
        tilt: f64,
    },
}

/// Lowest point of an outline and how it moves with the rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowestPoint {
    /// H, its depth below the centre of mass; m.
    pub depth: f64,
    /// H′; m/rad. The point stands at −H′ from the line through the centre of
    /// mass, positive to the right.
    pub slope: f64,
    /// H″; m/rad².
    pub curvature: f64,
}

impl Shape {
    /// Lowest point when the body has turned by `rotation` (rad) since release.
    pub fn lowest_point(&self, rotation: f64) -> LowestPoint {
        match *self {
            Self::OffsetDisc {
                radius,
                offset,
                angle,
            } => {
                let (sine, cosine) = (angle + rotation).sin_cos();
                LowestPoint {
                    depth: radius - offset * cosine,
                    slope: offset * sine,
                    curvature: offset * cosine,
                }
            }
            Self::Ellipse {
                semi_axes: [a, b],
                tilt,
            } => {
                let (sine, cosine) = (tilt + rotation).sin_cos();
                let difference = (a - b) * (a + b);
                let depth = (a * sine).hypot(b * cosine);
                let slope = difference * sine * cosine / depth;
                let turned = difference * (cosine - sine) * (cosine + sine);
                LowestPoint {
                    depth,
                    slope,
                    curvature: (turned - slope * slope) / depth,
                }
            }
        }
    }

    /// Horizontal distance of the lowest point from the centre of mass at
    /// release, positive to the right; m.
    pub fn lever_arm(&self) -> f64 {
        -self.lowest_point(0.0).slope
    }

    /// Moment of inertia about the centre of mass of a solid of this outline;
    /// kg m².
    ///
    /// The ellipsoid has m (a² + b²)/5. The sphere has 2/5 m R² about its
    /// geometric centre, and m ε² less about the centre of mass (parallel
    /// axes): the material that moved the centre of mass is taken to leave the
    /// moment about the geometric centre as it was. Not positive when the
    /// offset exceeds √(2/5) R.
    pub fn solid_inertia(&self, mass: f64) -> f64 {
        match *self {
            Self::OffsetDisc { radius, offset, .. } => {
                mass * (0.4 * radius * radius - offset * offset)
            }
            Self::Ellipse {
                semi_axes: [a, b], ..
            } => 0.2 * mass * (a * a + b * b),
        }
    }

    /// Least H over all rotations; m.
    pub(crate) fn least_depth(&self) -> f64 {
        match *self {
            Self::OffsetDisc { radius, offset, .. } => radius - offset,
            Self::Ellipse {
                semi_axes: [a, b], ..
            } => a.min(b),
        }
    }

    /// Largest |H″| over all rotations; m/rad². For the ellipse H + H″ is the
    /// radius of curvature, between b²/a and a²/b.
    pub(crate) fn largest_curvature(&self) -> f64 {
        match *self {
            Self::OffsetDisc { offset, .. } => offset,
            Self::Ellipse {
                semi_axes: [a, b], ..
            } => ((a - b) * (a + b)).abs() / a.min(b),
        }
    }
}

/// Share of the body's mass that a frictionless contact feels:
///
/// ```text
/// 1/m_eff = 1/m + r²/I,   m_eff/m = 1/(1 + m r²/I)
/// ```
///
/// * `mass`: m; kg
/// * `lever_arm`: r, distance of the line of the contact force from the centre
///   of mass; m
/// * `inertia`: I, moment of inertia about the centre of mass; kg m²
///
/// This is the one number by which a central model takes an eccentric contact
/// into account; it holds as long as the body hardly turns during the contact,
/// and says nothing of where the body touches next.
///
/// # Example
/// A uniform rod (I = m L²/12) struck at its end (r = L/2) feels a quarter of
/// its mass:
/// ```
/// use windfall_drop_rig::eccentric::shape::effective_mass_factor;
/// let factor = effective_mass_factor(2.0, 0.5, 2.0 / 12.0);
/// assert!((factor - 0.25).abs() < 1e-15);
/// ```
pub fn effective_mass_factor(mass: f64, lever_arm: f64, inertia: f64) -> f64 {
    1.0 / (1.0 + mass * lever_arm * lever_arm / inertia)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPES: [Shape; 3] = [
        Shape::OffsetDisc {
            radius: 0.01,
            offset: 0.0038,
            angle: 1.2,
        },
        Shape::Ellipse {
            semi_axes: [0.012, 0.009],
            tilt: 0.5,
        },
        Shape::Ellipse {
            semi_axes: [0.007, 0.015],
            tilt: -0.4,
        },
    ];

    /// The lowest of many points of the outline itself, drawn without H.
    #[test]
    fn closed_form_lowest_point_of_the_drawn_outline() {
        for shape in SHAPES {
            for step in 0..40 {
                let rotation = f64::from(step) * 0.17;
                let point = |i: i32| {
                    let t = f64::from(i) * std::f64::consts::TAU / 200_000.0;
                    let (own, turn) = match shape {
                        Shape::OffsetDisc {
                            radius,
                            offset,
                            angle,
                        } => {
                            // Own frame: centre of mass straight below the centre.
                            let own = [radius * t.cos(), offset + radius * t.sin()];
                            (own, angle + rotation)
                        }
                        Shape::Ellipse {
                            semi_axes: [a, b],
                            tilt,
                        } => ([a * t.cos(), b * t.sin()], tilt + rotation),
                    };
                    let (s, c) = turn.sin_cos();
                    [own[0] * c - own[1] * s, own[0] * s + own[1] * c]
                };
                let lowest = (0..200_000)
                    .map(point)
                    .min_by(|p, q| p[1].total_cmp(&q[1]))
                    .unwrap();
                let found = shape.lowest_point(rotation);
                assert!((found.depth + lowest[1]).abs() < 1e-11, "{shape:?}");
                assert!((found.slope + lowest[0]).abs() < 1e-6, "{shape:?}");
                assert!(found.depth >= shape.least_depth());
                assert!(found.curvature.abs() <= shape.largest_curvature() * (1.0 + 1e-12));
            }
        }
    }

    #[test]
    fn derivative_of_the_lowest_point() {
        for shape in SHAPES {
            for rotation in [0.0, 0.3, 2.0, -1.1] {
                let h = 1e-5;
                let (low, high) = (
                    shape.lowest_point(rotation - h),
                    shape.lowest_point(rotation + h),
                );
                let middle = shape.lowest_point(rotation);
                let slope = (high.depth - low.depth) / (2.0 * h);
                let curvature = (high.slope - low.slope) / (2.0 * h);
                assert!((middle.slope - slope).abs() < 1e-10, "{shape:?}");
                assert!((middle.curvature - curvature).abs() < 1e-10, "{shape:?}");
                assert!(slope != 0.0 && curvature != 0.0);
            }
        }
    }

    /// Solid sphere, 2/5 m R², both as a disc and as an ellipse of equal axes;
    /// moving the centre of mass takes m ε² away.
    #[test]
    fn closed_form_inertia_of_solids() {
        let disc = |offset| Shape::OffsetDisc {
            radius: 0.01,
            offset,
            angle: 0.0,
        };
        let ellipse = Shape::Ellipse {
            semi_axes: [0.01, 0.01],
            tilt: 0.3,
        };
        assert!((disc(0.0).solid_inertia(0.005) - 2e-7).abs() < 1e-20);
        assert!((ellipse.solid_inertia(0.005) - 2e-7).abs() < 1e-20);
        assert!((disc(0.003).solid_inertia(0.005) - 1.55e-7).abs() < 1e-20);
    }
}
