//! Arguments about records, the same for every command that reads them.

use clap::Args;
use simgap_record::{ChannelMap, MapFault, Mend, ReadOptions};

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
    /// The map.
    pub(crate) fn map(&self) -> Result<ChannelMap, MapFault> {
        ChannelMap::parse(&self.map)
    }

    /// What to read, with the names, the map and the mending that were asked for.
    pub(crate) fn applied_to(&self, options: ReadOptions) -> Result<ReadOptions, MapFault> {
        let options = match &self.columns {
            Some(columns) => options.with_columns(columns)?,
            None => options,
        };
        Ok(options.with_map(self.map()?).with_mend(self.mend()))
    }

    /// The arguments again, each with its value, for a command that is to repeat this one.
    pub(crate) fn words(&self) -> impl Iterator<Item = (&'static str, Option<String>)> {
        let map = self.map.iter().map(|entry| ("--map", Some(entry.clone())));
        let columns = self.columns.clone().map(|names| ("--columns", Some(names)));
        map.chain(columns)
            .chain(self.mend.then_some(("--mend", None)))
    }

    /// When faults are made good.
    pub(crate) fn mend(&self) -> Mend {
        if self.mend {
            Mend::Always
        } else {
            Mend::Foreign
        }
    }
}
