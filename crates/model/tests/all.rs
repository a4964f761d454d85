//! The integration tests, one program: each file is one of its modules.

mod bodies_and_beams;
mod exchange;
mod law_file;
mod model_file;
mod modes_and_frf;
mod sensitivity;
