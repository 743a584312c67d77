//! The account of a scene's energy.

use crate::binary;

/// Energies of contacts that are over, and of what came and left; J.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Account {
    pub normal: f64,
    pub friction: f64,
    pub drag: f64,
    pub walls: f64,
    pub brought: f64,
}

impl Account {
    /// Both together.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            normal: self.normal + other.normal,
            friction: self.friction + other.friction,
            drag: self.drag + other.drag,
            walls: self.walls + other.walls,
            brought: self.brought + other.brought,
        }
    }
}

/// Energies of a scene; J.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, utoipa::ToSchema)]
#[schema(as = EnergyOutcome)]
pub struct Energy {
    /// Of translation.
    pub kinetic: f64,
    /// Of rotation.
    pub rotational: f64,
    /// In gravity, against the origin.
    pub potential: f64,
    /// Put into normal contacts that last: stored or lost so far.
    pub in_contacts: f64,
    /// Put into friction and rolling of contacts that last.
    pub in_friction: f64,
    /// Lost in normal contacts that are over.
    pub lost_in_contacts: f64,
    /// Lost by friction and rolling of contacts that are over.
    pub lost_by_friction: f64,
    /// Lost by drag.
    pub lost_by_drag: f64,
    /// Done by moving walls.
    pub done_by_walls: f64,
    /// Of fruit that came less that of fruit that left; and what places in gravity change by where
    /// fruit go over a periodic end.
    #[serde(skip)]
    pub brought: f64,
}

/// Of all energies: what rounding may come to; 1.
const ROUNDING: f64 = 1e-9;
binary!(Energy {
    kinetic,
    rotational,
    potential,
    in_contacts,
    in_friction,
    lost_in_contacts,
    lost_by_friction,
    lost_by_drag,
    done_by_walls,
    brought
});

impl Energy {
    /// Both together: of parts of a scene.
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            kinetic: self.kinetic + other.kinetic,
            rotational: self.rotational + other.rotational,
            potential: self.potential + other.potential,
            in_contacts: self.in_contacts + other.in_contacts,
            in_friction: self.in_friction + other.in_friction,
            lost_in_contacts: self.lost_in_contacts + other.lost_in_contacts,
            lost_by_friction: self.lost_by_friction + other.lost_by_friction,
            lost_by_drag: self.lost_by_drag + other.lost_by_drag,
            done_by_walls: self.done_by_walls + other.done_by_walls,
            brought: self.brought + other.brought,
        }
    }

    /// What the account lacks: zero but for the errors of the time step; J.
    pub fn closure(&self) -> f64 {
        self.kinetic
            + self.rotational
            + self.potential
            + self.in_contacts
            + self.in_friction
            + self.lost_in_contacts
            + self.lost_by_friction
            + self.lost_by_drag
            - self.done_by_walls
            - self.brought
    }

    /// What the account lacks over what was lost, or over a billionth of all energies where even
    /// less was lost, so that rounding does not count; 1.
    ///
    /// * `first`: what it lacked at the beginning; J
    pub fn relative_closure(&self, first: f64) -> f64 {
        let held = self.kinetic + self.rotational + self.potential.abs();
        let size = held + self.done_by_walls.abs() + self.brought.abs();
        (self.closure() - first)
            / self
                .lost()
                .abs()
                .max(ROUNDING * size)
                .max(f64::MIN_POSITIVE)
    }

    /// What was lost or is held in contacts, by all mechanisms; J.
    pub fn lost(&self) -> f64 {
        self.in_contacts
            + self.in_friction
            + self.lost_in_contacts
            + self.lost_by_friction
            + self.lost_by_drag
    }
}
