//! The ports that parts of the model file bring with them: laws that read the state and push it, beyond what their parts have in
//! the matrices.
//!
//! A port is a file here with its law and where the model has it, and its line in the list below.

mod gravity;
mod orifice;

use simgap_integrate::exact::Element;
use simgap_model::Model;

/// Every kind of port, in the order in which they are solved.
const KINDS: [fn(&Model) -> Vec<Element>; 2] = [gravity::of, orifice::of];

/// The ports of a model.
pub(crate) fn ports(model: &Model) -> Vec<Element> {
    KINDS.iter().flat_map(|of| of(model)).collect()
}
