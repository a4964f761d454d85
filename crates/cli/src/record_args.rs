//! Arguments about records, the same for every command that reads them.

use clap::Args;
use simgap_record::{ChannelMap, MapFault, Mend};

/// How the columns of records are called, and what is done about their faults.
#[derive(Args, Clone, Default)]
pub(crate) struct RecordArgs {
    /// Column of the records that is a channel of the model, with a unit where the file has none:
    /// `--map y=Pos_Mold`, `--map "y=Pos_Mold [mm]"`, `--map "t=Zeit [ms]"`; may be given several
    /// times.
    #[arg(long = "map", value_name = "CHANNEL=COLUMN")]
    map: Vec<String>,
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

    /// The arguments again, each with its value, for a command that is to repeat this one.
    pub(crate) fn words(&self) -> impl Iterator<Item = (&'static str, Option<String>)> {
        let map = self.map.iter().map(|entry| ("--map", Some(entry.clone())));
        map.chain(self.mend.then_some(("--mend", None)))
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
