//! Prolate spheroids as all the spheres that fit into them: on each direction of the surface lies
//! one, whose centre is on the axis.

use crate::vector::{Vector, dot, length, plus_scaled, subtract};

/// A spheroid that is longer than thick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spheroid {
    /// Semi-axis along it, a; m.
    pub long: f64,
    /// Semi-axis across it, b; m.
    pub wide: f64,
}

/// A sphere that fits into a spheroid, with how its radius changes along the axis.
#[derive(Clone, Copy, Debug)]
struct Fitting {
    radius: f64,
    slope: f64,
    curvature: f64,
}

impl Spheroid {
    /// Square of half the distance of the foci, a² − b²; m².
    fn focal(&self) -> f64 {
        self.long * self.long - self.wide * self.wide
    }

    /// How far from the centre the outermost of the spheres is, which has the curvature of the tip;
    /// m.
    pub fn reach(&self) -> f64 {
        self.focal() / self.long
    }

    /// Radius of the sphere at a place of the axis; m.
    ///
    /// * `along`: from the centre; m
    pub fn radius(&self, along: f64) -> f64 {
        self.wide * (1.0 - along * along / self.focal()).max(0.0).sqrt()
    }

    /// Geometric mean of the two radii of curvature of the surface that the sphere touches; m.
    ///
    /// # Source
    /// Principal radii r and r³a²/b⁴ of the surface of revolution; the mean stands for both in
    /// Hertz's contact: Johnson (1985), Contact Mechanics, section 4.2.
    pub fn curvature_radius(&self, along: f64) -> f64 {
        let radius = self.radius(along);
        radius * radius * self.long / (self.wide * self.wide)
    }

    /// Where the sphere is that touches a plane; m.
    ///
    /// * `cosine`: of the angle between the axis and the plane's normal towards it
    pub fn towards(&self, cosine: f64) -> f64 {
        let focal = self.focal();
        focal * cosine / (self.wide * self.wide + focal * cosine * cosine).sqrt()
    }

    fn fitting(&self, along: f64) -> Fitting {
        let focal = self.focal();
        let height = (1.0 - along * along / focal).max(f64::MIN_POSITIVE).sqrt();
        Fitting {
            radius: self.wide * height,
            slope: -self.wide * along / (focal * height),
            curvature: -self.wide / (focal * height * height * height),
        }
    }
}

/// Places on the axis of a fruit of which one is looked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spine {
    pub shape: Spheroid,
    /// Centre of the spheroid; m.
    pub centre: Vector,
    /// Its axis; length 1.
    pub axis: Vector,
}

impl Spine {
    pub(crate) fn at(&self, along: f64) -> Vector {
        plus_scaled(self.centre, self.axis, along)
    }

    /// Where on the axis the sphere is that reaches deepest into a wall; m.
    ///
    /// The depth, radius less distance, is a concave function of the place where the wall is convex.
    ///
    /// * `from`: a place to begin at; m
    /// * `normal`: towards the closest point of the wall from a place; length 1
    pub(crate) fn deepest(&self, from: f64, normal: impl Fn(Vector) -> Vector) -> f64 {
        let reach = self.shape.reach();
        let (mut low, mut high) = (-reach, reach);
        let mut along = from;
        for step in 0..MOST_STEPS {
            let cosine = dot(normal(self.at(along)), self.axis);
            let wanted = self.shape.towards(cosine);
            if (wanted - along).abs() <= CLOSE * self.shape.long {
                return wanted;
            }
            // The slope of the depth has the sign of the way to where a plane would be touched.
            match wanted > along {
                true => low = along,
                false => high = along,
            }
            let halves = step % 3 == 2 || wanted <= low || wanted >= high;
            along = if halves { 0.5 * (low + high) } else { wanted };
        }
        along
    }
}

/// Steps at most to a deepest sphere.
const MOST_STEPS: usize = 60;
/// So near to it is there, over the length; 1.
const CLOSE: f64 = 1e-12;

/// Where on their axes the spheres of two fruit are that overlap most; m. Of a fruit that is no
/// spheroid the sphere is given.
///
/// Their overlap is a concave function of both places: Newton's steps, halved where it falls.
///
/// * `centres`: of spheres that are given; m
/// * `from`: places to begin at; m
pub(crate) fn closest_spheres(
    spines: [Option<&Spine>; 2],
    centres: [Vector; 2],
    from: [f64; 2],
) -> [f64; 2] {
    let at = |side: usize, along: f64| spines[side].map_or(centres[side], |own| own.at(along));
    let fitting = |side: usize, along: f64| spines[side].map(|own| own.shape.fitting(along));
    let overlap = |[s, t]: [f64; 2]| {
        let radius = |side, along| fitting(side, along).map_or(0.0, |own| own.radius);
        radius(0, s) + radius(1, t) - length(subtract(at(1, t), at(0, s)))
    };
    let held = |side: usize, along: f64| {
        let reach = spines[side].map_or(0.0, |own| own.shape.reach());
        along.clamp(-reach, reach)
    };
    let size = spines
        .iter()
        .flatten()
        .map(|own| own.shape.long)
        .fold(0.0, f64::max);
    let mut places = from;
    let mut best = overlap(places);
    for _ in 0..MOST_STEPS {
        let between = subtract(at(1, places[1]), at(0, places[0]));
        let distance = length(between);
        if distance <= 0.0 {
            return places;
        }
        let normal = between.map(|own| own / distance);
        // Along each axis: slope and curvature of the overlap.
        let axis = |side: usize| spines[side].map_or([0.0; 3], |own| own.axis);
        let cosines = [dot(normal, axis(0)), -dot(normal, axis(1))];
        let side = |side: usize| match fitting(side, places[side]) {
            Some(own) => {
                let bent = (1.0 - cosines[side] * cosines[side]) / distance;
                (own.slope + cosines[side], own.curvature - bent)
            }
            None => (0.0, -1.0),
        };
        let ([g, h], [gg, hh]) = {
            let ((g, gg), (h, hh)) = (side(0), side(1));
            ([g, h], [gg, hh])
        };
        let gh = (dot(axis(0), axis(1)) + cosines[0] * cosines[1]) / distance;
        let determinant = gg * hh - gh * gh;
        let way = match determinant > 0.0 {
            true => [
                -(hh * g - gh * h) / determinant,
                -(gg * h - gh * g) / determinant,
            ],
            // Nearly parallel and long: the way up of each for itself.
            false => [-g / gg, -h / hh],
        };
        let mut part = 1.0;
        let next = loop {
            let next = [0, 1].map(|side| held(side, places[side] + part * way[side]));
            let found = overlap(next);
            if found >= best - f64::EPSILON * size || part < 1e-6 {
                best = best.max(found);
                break next;
            }
            part *= 0.5;
        };
        let moved = (next[0] - places[0]).abs().max((next[1] - places[1]).abs());
        places = next;
        if moved <= CLOSE * size {
            return places;
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{turn_about, turned};

    const FRUIT: Spheroid = Spheroid {
        long: 0.05,
        wide: 0.03,
    };

    /// A spheroid turned by an angle about an axis.
    fn spine(centre: Vector, about: Vector, angle: f64) -> Spine {
        let size = length(about);
        let turn = turn_about(about.map(|own| own / size), angle);
        Spine {
            shape: FRUIT,
            centre,
            axis: turned(turn, [1.0, 0.0, 0.0]),
        }
    }

    #[test]
    fn closed_form_the_height_of_a_tangent_plane() {
        // Support function of a spheroid: h² = b² + (a² − b²) cos².
        for degrees in 0..=18 {
            let own = spine(
                [0.0; 3],
                [0.0, 1.0, 0.0],
                f64::from(10 * degrees).to_radians(),
            );
            let down = [0.0, 0.0, -1.0];
            let along = own.deepest(0.0, |_| down);
            let found = FRUIT.radius(along) - own.at(along)[2];
            let wanted = (9e-4 + 16e-4 * own.axis[2] * own.axis[2]).sqrt();
            assert!((found - wanted).abs() < 1e-16, "{degrees}");
        }
        assert!((FRUIT.curvature_radius(FRUIT.reach()) - 0.018).abs() < 1e-17);
        // At the waist 30 mm and 0.05²/0.03 m.
        let wanted = (0.03 * 0.0025 / 0.03_f64).sqrt();
        assert!((FRUIT.curvature_radius(0.0) - wanted).abs() < 1e-16);
    }

    #[test]
    fn matches_scipy_where_a_spheroid_is_nearest_to_a_point() {
        // scipy.optimize.minimize_scalar of SciPy 1.17.1 over the angle of the ellipse, distance of
        // the point (x, y) outside.
        for ([x, y], wanted) in [
            ([0.06, 0.02], 0.016_210_053_395_827_92),
            ([0.01, 0.05], 0.020_484_353_020_527_46),
            ([0.055, 0.001], 0.005_021_723_736_966_625),
        ] {
            let own = spine([0.0; 3], [0.0, 0.0, 1.0], 0.0);
            let point = [x, y, 0.0];
            let normal = |place: Vector| {
                let way = subtract(point, place);
                way.map(|own| own / length(way))
            };
            let along = own.deepest(-0.01, normal);
            let found = length(subtract(point, own.at(along))) - FRUIT.radius(along);
            assert!((found - wanted).abs() < 1e-10, "{found} {wanted}");
            let both = closest_spheres([Some(&own), None], [[0.0; 3], point], [0.0; 2]);
            assert!((both[0] - along).abs() < 1e-9, "{both:?} {along}");
        }
    }

    #[test]
    fn matches_scipy_where_two_spheroids_are_nearest() {
        // Smallest distance of two ellipsoids by scipy.optimize.minimize (SLSQP, 20 starts) over
        // their surfaces.
        for (centre, about, angle, wanted) in [
            ([0.0, 0.0, 0.07], [0.0, 1.0, 0.0], 0.0, 0.01),
            (
                [0.02, 0.01, 0.07],
                [0.0, 0.0, 1.0],
                1.2,
                0.011_765_862_121_382_45,
            ),
            (
                [0.06, 0.03, 0.08],
                [0.3, 1.0, 0.5],
                0.8,
                0.038_267_777_143_119_83,
            ),
            (
                [0.11, 0.0, 0.01],
                [0.0, 1.0, 0.2],
                2.5,
                0.016_608_901_829_160_21,
            ),
        ] {
            let one = spine([0.0; 3], [0.0, 0.0, 1.0], 0.0);
            let two = spine(centre, about, angle);
            for from in [[0.0, 0.0], [0.03, -0.03], [-0.03, -0.03]] {
                let [s, t] = closest_spheres([Some(&one), Some(&two)], [[0.0; 3]; 2], from);
                let distance = length(subtract(two.at(t), one.at(s)));
                let found = distance - FRUIT.radius(s) - FRUIT.radius(t);
                assert!((found - wanted).abs() < 1e-8, "{found} {wanted}");
            }
        }
    }
}
