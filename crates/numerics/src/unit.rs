//! Physical units at the boundary.
