//! Frames of a scene that has run: pictures, histories, files for ParaView.

pub mod camera;
pub mod figure;
pub mod history;
pub mod order;
pub mod read;
pub mod view;
pub mod vtk;
