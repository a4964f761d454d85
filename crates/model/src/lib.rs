//! Lumped models: masses, springs and dampers to M, C, K; modes; frequency responses; the model file.

mod matrices;

pub use matrices::StructuralMatrices;
