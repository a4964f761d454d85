//! The integration tests, one program: each file is one of its modules.

mod cases;
mod machine;
