//! Arguments about records, the same for every command that reads them.

use clap::Args;
use simgap_app::input::RecordOptions;

/// How the columns of records are called, and what is done about their faults.
#[derive(Args, Clone, Default)]
pub(crate) struct RecordArgs {
    /// Column of the records that is a channel of the model, with a unit where the file has none:
    /// `--map y=Pos_Mold`, `--map "y=Pos_Mold [mm]"`, `--map "t=Zeit [ms]"`; may be given several
    /// times.
    #[arg(long = "map", value_name = "CHANNEL=COLUMN")]
    map: Vec<String>,
    /// Names and units of the columns of a table of text without a header, in their order:
    /// `--columns "t [s],u [N],y [mm]"`.
    #[arg(long, value_name = "NAMES")]
    columns: Option<String>,
    /// Fill missing samples and resample an uneven time base also in CSV files of the contract's
    /// own form, where they are errors otherwise.
    #[arg(long)]
    mend: bool,
}

impl RecordArgs {
    /// The same for whoever reads.
    pub(crate) fn options(&self) -> RecordOptions {
        RecordOptions {
            map: self.map.clone(),
            columns: self.columns.clone(),
            mend: self.mend,
        }
    }
}
