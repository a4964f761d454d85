//! The integration tests, one program: each file is one of its modules.

mod equivalence;
mod generation;
mod scoring;
mod sealing;
