//! Force laws, one per file, and their registry.

pub mod adams_impact;
pub mod any_law;
mod any_law_size;
mod damped_power;
pub mod define_law;
pub mod flores;
pub mod force_table;
pub mod herbert_mcwhannell;
pub mod hertz;
pub mod hunt_crossley;
pub mod kelvin_voigt;
pub mod kind;
pub mod kuwabara_kono;
pub mod lankarani_nikravesh;
pub mod power;
pub mod thornton;
pub mod tsuji;
pub mod user;
mod user_body;
mod user_check;
pub mod user_finding;
mod user_memory_check;
pub(crate) mod user_start;
pub mod walton_braun;
