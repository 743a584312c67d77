//! Oblique impact of an elastic sphere with friction, by annuli of its contact area that
//! stick or slip each for itself: the problem of Maw, Barber and Fawcett (1976), Wear 38,
//! 101, solved apart from the engine.
//!
//! Tractions are sums of Hertz's and Mindlin's for circles of all radii. The circle of
//! radius x then behaves like a spring of its own: it bears 2 E* (d − x²/R) dx, shears by
//! 2 G* u dx, and slips where that is more than μ times what it bears (Jäger 1993, Arch.
//! Appl. Mech. 63, 463; Popov and Heß 2015, Method of Dimensionality Reduction, chapter 5).
#![allow(dead_code)]

/// Circles of the contact area, with E* = 1 and R = 1.
pub struct Annuli {
    /// x² of each.
    squares: Vec<f64>,
    width: f64,
    /// Shear of each.
    shears: Vec<f64>,
    friction: f64,
    /// G*/E*, which is Mindlin's k_t/k_n.
    ratio: f64,
}

impl Annuli {
    /// A contact that will not be deeper than `deepest`.
    pub fn new(count: usize, deepest: f64, friction: f64, ratio: f64) -> Self {
        let width = deepest.sqrt() / count as f64;
        let square = |number| ((number as f64 + 0.5) * width).powi(2);
        Self {
            squares: (0..count).map(square).collect(),
            width,
            shears: vec![0.0; count],
            friction,
            ratio,
        }
    }

    /// Normal and tangential force at a depth, after the bodies slid on by `way`.
    pub fn forces(&mut self, depth: f64, way: f64) -> (f64, f64) {
        let (mut normal, mut tangential) = (0.0, 0.0);
        for (square, shear) in self.squares.iter().zip(&mut self.shears) {
            let pressed = (depth - square).max(0.0);
            let limit = self.friction * pressed / self.ratio;
            *shear = (*shear + way).clamp(-limit, limit);
            normal += pressed;
            tangential += *shear;
        }
        let both = 2.0 * self.width;
        (both * normal, both * self.ratio * tangential)
    }
}

/// Tangential velocity of the surface of a solid sphere after an impact, over its normal
/// velocity before, for that before, of a sphere that loses nothing along the normal.
pub fn slip_after(before: f64, friction: f64, ratio: f64) -> f64 {
    // m = 1, v_n = 1e-3; Hertz's greatest depth and time of contact.
    let speed = 1e-3;
    let deepest = (15.0_f64 / 16.0 * speed * speed).powf(0.4);
    let step = 2.943_275 * deepest / speed / 6000.0;
    let mut contact = Annuli::new(1200, 1.0001 * deepest, friction, ratio);
    let (mut depth, mut rate, mut slip) = (0.0, speed, before * speed);
    // By half a step to the first force, then from force to force.
    depth += 0.5 * step * rate;
    let mut way = 0.5 * step * slip;
    while depth > 0.0 {
        let (normal, tangential) = contact.forces(depth, way);
        rate -= step * normal;
        // What turns it adds 5/2: 1/m + R²/I = 7/(2 m).
        slip -= 3.5 * step * tangential;
        depth += step * rate;
        way = step * slip;
    }
    slip / speed
}
