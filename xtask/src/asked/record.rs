//! A record as a user would have it.

use std::path::Path;

use simgap_model::Model;
use simgap_record::{Record, RecordError, write_csv_atomic};

/// Name and unit of every column, and the fewest digits that read back as the same double.
pub(crate) fn write_record(path: &Path, model: &Model, record: &Record) -> Result<(), RecordError> {
    let named = model.inputs.iter().map(|input| &input.channel);
    let named = named.chain(model.outputs.iter().map(|output| &output.channel));
    let channels = named
        .map(|name| record.require(name))
        .collect::<Result<Vec<_>, _>>()?;
    let mut headers = vec!["t [s]".to_string()];
    headers.extend(channels.iter().map(|c| format!("{} [{}]", c.name, c.unit)));
    let mut columns = vec![record.time_s()];
    columns.extend(channels.iter().map(|c| c.values.as_slice()));
    write_csv_atomic(path, &headers, &columns)
}
