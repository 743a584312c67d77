//! Frames of a scene that has run: pictures, histories, files for ParaView.

pub(crate) mod camera;
pub(crate) mod figure;
pub mod history;
pub(crate) mod order;
pub mod read;
pub mod table;
pub mod view;
pub(crate) mod vtk;
