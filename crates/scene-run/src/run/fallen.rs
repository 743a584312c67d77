//! Fruit that fell past everything that could have caught them.

use crate::file::key::short;
use crate::geometry::{Bounds, geometry_of};
use windfall_files::found::FindingOutcome;
use windfall_scene::motion::simulation::Simulation;
use windfall_scene::scene::Sink;
use windfall_scene::vector::{Vector, dot, length, scaled};

/// Fruit that are below all walls and sinks at the end and still fall: what should have caught
/// them has a gap, or is missing.
pub fn finding_of_fallen(simulation: &Simulation) -> Option<FindingOutcome> {
    let scene = &simulation.scene;
    let size = length(scene.gravity);
    if size == 0.0 || scene.walls.is_empty() && scene.sinks.is_empty() {
        return None;
    }
    let down = scaled(scene.gravity, 1.0 / size);
    let depth = |place: Vector| dot(place, down);
    let (_, room) = geometry_of(scene);
    let depths = |own: &Bounds| own.corners().into_iter().map(depth).collect::<Vec<f64>>();
    let mut all = depths(&room);
    let highest = all.iter().copied().fold(f64::INFINITY, f64::min);
    for &Sink { low, high, .. } in &scene.sinks {
        all.extend(depths(&Bounds { low, high }));
    }
    let lowest = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
    // Walls that move may reach farther down than they do at rest.
    let moves = scene.walls.iter().any(|own| !own.motion.stays());
    let height = if moves { lowest - highest } else { 0.0 };
    let (mut fallen, mut farthest) = (0, 0.0_f64);
    for own in simulation.fruit() {
        let diameter = 2.0 * scene.fruit[own.fruit as usize].radius;
        let below = depth(own.place) - lowest;
        if below > height.max(diameter) && depth(own.velocity) > 0.0 {
            fallen += 1;
            farthest = farthest.max(below);
        }
    }
    (fallen > 0).then(|| {
        FindingOutcome::new(
            "fell-out",
            format!(
                "{fallen} fruit fell past every wall and sink, by up to {} m at the end: look for a \
                 gap between walls, or add a floor or a sink",
                short(farthest)
            ),
        )
    })
}
