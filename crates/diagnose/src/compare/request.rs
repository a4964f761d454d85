//! What is asked of two traces.

use simgap_record::Record;

/// What is compared.
pub struct CompareRequest<'a> {
    /// The measured record.
    pub measured: &'a Record,
    /// The simulated record.
    pub simulated: &'a Record,
    /// Columns that belong together, measured and simulated; empty for those of the same name.
    pub pairs: &'a [(String, String)],
    /// Columns of both that drive the machine, and are not to be compared.
    pub inputs: &'a [String],
    /// Whether both records begin at the same moment, whatever their stamps say.
    pub align_start: bool,
}
