//! The integration tests, one program: each file is one of its modules.

mod machine;
mod mold;
mod servo;
