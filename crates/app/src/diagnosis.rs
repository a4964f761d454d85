//! A diagnosis: what is asked, the answer, and the files it is written to.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use simgap_diagnose::audit::audit;
use simgap_diagnose::{Cancel, CheckSeries, Limit, Outcome, Progress, Request, diagnose};
use simgap_model::Model;
use simgap_record::{AuditFinding, AuditTopic, Record};
use simgap_report::page::{PictureFile, Report, ReportContext, ReportInput, report};
use simgap_simulate::ExternalPlant;

use crate::folder::{Folder, not_an_input};
use crate::input::{Input, RecordOptions, conversions, idle_masses};
use crate::manifest::Results;
use crate::text::{command, file_name, stem};
use crate::{AppError, effects, json, repeated};

/// Folder of the predictions, inside the folder of the results.
const PREDICTIONS: &str = "predictions";
/// Folder of the pictures of the page and their data, inside it too.
const PICTURES: &str = "pictures";

/// What is asked.
pub struct Question<'a> {
    /// The model.
    pub model: &'a Model,
    /// The file it is from; `None` for a model that is from none.
    pub model_file: Option<&'a Path>,
    /// Records to learn from.
    pub train: &'a [Input],
    /// Records to judge by; empty to hold back the last part of each training record.
    pub check: &'a [Input],
    /// How the records were read.
    pub records: &'a RecordOptions,
    /// Kinds to take out of the catalogue.
    pub withheld: &'a [String],
    /// Seed of anything random.
    pub seed: u64,
    /// What ends the search with the best answer so far.
    pub limit: Limit<'a>,
    /// The simulator that the model stands for, where it stands for one.
    pub plant: Option<Arc<ExternalPlant>>,
    /// Ends the whole work without an answer.
    pub cancel: Cancel,
}

/// The answer, with everything its files are made of.
pub struct Answer {
    /// The answer, the corrected model, the predictions.
    pub outcome: Outcome,
    /// What is odd about the records before the physics.
    pub findings: Vec<AuditFinding>,
    /// What the page tells of its origin.
    pub context: ReportContext,
    /// The model as given.
    pub model: Model,
}

/// Refuses records whose predictions would be written to one file.
///
/// # Errors
/// [`AppError::SameStem`].
pub fn distinct_stems<'a>(paths: impl IntoIterator<Item = &'a PathBuf>) -> Result<(), AppError> {
    let mut seen: BTreeMap<String, &PathBuf> = BTreeMap::new();
    for path in paths {
        if let Some(first) = seen.insert(stem(path), path) {
            return Err(AppError::SameStem {
                first: first.clone(),
                second: path.clone(),
                stem: stem(path),
            });
        }
    }
    Ok(())
}

/// Refuses kinds to withhold that neither the catalogue nor a law of the model is.
///
/// # Errors
/// [`AppError::UnknownKind`].
pub fn known_kinds(withheld: &[String], model: Option<&Model>) -> Result<(), AppError> {
    withheld
        .iter()
        .try_for_each(|kind| effects::known("--withhold: ", kind, model).map(drop))
}

/// Whether the quality of single columns does not say the same.
#[must_use]
pub fn is_beyond_quality(finding: &AuditFinding) -> bool {
    !matches!(finding.topic, AuditTopic::Clipping)
}

impl Question<'_> {
    /// The records that the answer is judged by.
    fn judged(&self) -> &[Input] {
        if self.check.is_empty() {
            self.train
        } else {
            self.check
        }
    }

    /// Refuses a question whose answer would say nothing: records that repeat each other.
    ///
    /// # Errors
    /// [`AppError::TrainTwice`], [`AppError::CheckRepeats`].
    pub fn refuse_repeats(&self) -> Result<(), AppError> {
        repeated::refuse(self.model, self.train, self.check)
    }

    /// Whether the answer can be written to a folder; nothing stays of the attempt.
    ///
    /// # Errors
    /// [`AppError`] when it cannot.
    pub fn attempt(&self, out: &Path) -> Result<(), AppError> {
        let stems: Vec<String> = self
            .judged()
            .iter()
            .map(|input| stem(&input.path))
            .collect();
        let files = files(out, &stems, &[]);
        let records = self.train.iter().chain(self.check);
        let records = records.filter(|input| input.is_file);
        let records = records.map(|input| input.path.as_path());
        let inputs: Vec<&Path> = self.model_file.into_iter().chain(records).collect();
        files
            .iter()
            .try_for_each(|file| not_an_input(file, &inputs))?;
        Folder::attempt(out, &[PREDICTIONS, PICTURES], &files)
    }

    /// Does the work.
    ///
    /// # Errors
    /// [`AppError::Diagnose`] when the records do not fit the model, the model cannot be simulated, or the work
    /// was cancelled.
    pub fn answer(&self, progress: Progress<'_>) -> Result<Answer, AppError> {
        let of = |inputs: &'_ [Input]| -> Vec<_> {
            inputs.iter().map(|input| input.record.clone()).collect()
        };
        let (train, check) = (of(self.train), of(self.check));
        let request = Request {
            withheld: self.withheld,
            limit: self.limit,
            plant: self.plant.clone(),
            cancel: self.cancel.clone(),
            ..Request::new(self.model, &train, &check)
        };
        let all: Vec<&Record> = train.iter().chain(&check).map(|record| &**record).collect();
        // What keeps the audit from its work is told by the diagnosis, in the same words as ever.
        let findings = audit(self.model, &all).unwrap_or_default();
        let mut outcome = diagnose(&request, progress)?;
        let notes = &mut outcome.diagnosis.notes;
        notes.extend(
            all.iter()
                .flat_map(|record| conversions(record, self.model)),
        );
        notes.extend(idle_masses(self.model));
        let inputs = self.train.iter().chain(self.check);
        notes.extend(inputs.flat_map(|input| input.notes.clone()));
        let beyond_quality = findings.iter().filter(|finding| is_beyond_quality(finding));
        notes.extend(beyond_quality.map(ToString::to_string));
        Ok(Answer {
            outcome,
            findings,
            context: self.context(),
            model: self.model.clone(),
        })
    }

    fn context(&self) -> ReportContext {
        let names = |inputs: &[Input]| {
            let paths = inputs.iter().map(|input| file_name(&input.path));
            paths.collect()
        };
        ReportContext {
            program_version: env!("CARGO_PKG_VERSION").to_string(),
            model_file: self.model_file.map(file_name).unwrap_or_default(),
            train_records: names(self.train),
            check_records: names(self.check),
            command_line: self.command_line().unwrap_or_default(),
            seed: self.seed,
        }
    }

    /// The command that makes the result again, with the names of the files but not their folders, so
    /// that the same input gives the same page wherever it lies; `None` where the model or a record is from no file.
    fn command_line(&self) -> Option<String> {
        let mut inputs = self.train.iter().chain(self.check);
        if !inputs.all(|input| input.is_file) {
            return None;
        }
        let mut words = vec![
            "simgap".to_string(),
            "diagnose".to_string(),
            file_name(self.model_file?),
        ];
        let mut option = |name: &str, value: String| words.extend([name.to_string(), value]);
        for (name, inputs) in [("--train", self.train), ("--check", self.check)] {
            for input in inputs {
                option(name, file_name(&input.path));
            }
        }
        for (name, value) in self.records.words() {
            words.push(name.to_string());
            words.extend(value);
        }
        let mut option = |name: &str, value: String| words.extend([name.to_string(), value]);
        for kind in self.withheld {
            option("--withhold", kind.clone());
        }
        if self.seed != 0 {
            option("--seed", self.seed.to_string());
        }
        option("--out", "DIR".to_string());
        Some(command(&words))
    }
}

impl Answer {
    /// The text of `diagnosis.json`.
    ///
    /// # Errors
    /// [`AppError::Json`].
    pub fn json(&self) -> Result<String, AppError> {
        json(&self.outcome.diagnosis)
    }

    /// The page and its pictures.
    ///
    /// # Errors
    /// [`AppError::Report`] when a picture cannot be drawn.
    pub fn report(&self) -> Result<Report, AppError> {
        Ok(report(&ReportInput {
            diagnosis: &self.outcome.diagnosis,
            series: &self.outcome.series,
            motions: &self.outcome.motions,
            nominal: Some(&self.model),
            corrected: Some(&self.outcome.corrected),
            context: &self.context,
        })?)
    }

    /// The text of `corrected.toml`; `path` names it in messages.
    ///
    /// # Errors
    /// [`AppError::Model`] when the corrected model cannot be written.
    pub fn corrected(&self, path: &Path) -> Result<String, AppError> {
        let text = self.outcome.corrected.to_toml();
        text.map_err(|error| AppError::Model {
            path: path.into(),
            error,
        })
    }

    /// Writes everything, all files together; everything is made before the first is written. Returns the text of
    /// `diagnosis.json`.
    ///
    /// # Errors
    /// [`AppError`] when the folder cannot be written to, or a prediction grows beyond all bounds.
    pub fn write(&self, out: &Path, with_sets: bool) -> Result<String, AppError> {
        let json = self.json()?;
        let corrected = self.corrected(&out.join("corrected.toml"))?;
        let report = self.report()?;
        let series = &self.outcome.series;
        let stems: Vec<String> = series.iter().map(stem_of).collect();
        bounded(series)?;
        let all = files(out, &stems, &report.pictures);
        let folder = Folder::make(out, &[PREDICTIONS, PICTURES], &all)?;
        let mut results = Results::new(out, "diagnose");
        for series in series {
            add_predictions(series, &mut results)?;
        }
        results.add(Path::new("corrected.toml"), &corrected)?;
        for picture in &report.pictures {
            let [svg, csv] = picture_files(Path::new(""), picture);
            results.add(&svg, &picture.svg)?;
            results.add(&csv, &picture.csv)?;
        }
        results.add(Path::new("report.html"), &report.html)?;
        results.add(Path::new("diagnosis.json"), &json)?;
        if with_sets {
            results.add(Path::new("sets.json"), &crate::json(&self.outcome.sets)?)?;
        }
        results.finish(folder)?;
        Ok(json)
    }
}

/// The files of a result.
fn files(out: &Path, stems: &[String], pictures: &[PictureFile]) -> Vec<PathBuf> {
    let named = ["diagnosis.json", "corrected.toml", "report.html"].map(|name| out.join(name));
    let predictions = stems.iter().map(|stem| prediction_file(out, stem));
    let pictures = pictures.iter().flat_map(|one| picture_files(out, one));
    named
        .into_iter()
        .chain(predictions)
        .chain(pictures)
        .collect()
}

fn prediction_file(out: &Path, stem: &str) -> PathBuf {
    out.join(PREDICTIONS).join(format!("{stem}.csv"))
}

fn picture_files(out: &Path, picture: &PictureFile) -> [PathBuf; 2] {
    let at = |extension| {
        out.join(PICTURES)
            .join(format!("{}.{extension}", picture.name))
    };
    [at("svg"), at("csv")]
}

/// The name that the predictions of a record go by.
#[must_use]
pub fn stem_of(series: &CheckSeries) -> String {
    stem(Path::new(&series.record))
}

/// Refuses predictions that no file can hold.
fn bounded(series: &[CheckSeries]) -> Result<(), AppError> {
    for one in series {
        for channel in &one.channels {
            let mut values = channel.nominal.iter().chain(&channel.corrected);
            if values.any(|value| !value.is_finite()) {
                return Err(AppError::RunsAway {
                    record: one.record.clone(),
                    channel: channel.channel.clone(),
                });
            }
        }
    }
    Ok(())
}

/// Headers and columns of the predictions of a record: `t [s]`, then of each output what was measured, what the model
/// as given predicts, and what the corrected one predicts.
#[must_use]
pub fn prediction_columns(series: &CheckSeries) -> (Vec<String>, Vec<&[f64]>) {
    let mut headers = vec!["t [s]".to_string()];
    let mut columns: Vec<&[f64]> = vec![&series.time_s];
    for channel in &series.channels {
        for (name, values) in [
            ("measured", &channel.measured),
            ("nominal", &channel.nominal),
            ("corrected", &channel.corrected),
        ] {
            headers.push(format!("{} {name} [{}]", channel.channel, channel.unit));
            columns.push(values);
        }
    }
    (headers, columns)
}

fn add_predictions(series: &CheckSeries, results: &mut Results<'_>) -> Result<(), AppError> {
    let (headers, columns) = prediction_columns(series);
    let file = prediction_file(Path::new(""), &stem_of(series));
    results.add_csv(&file, &headers, &columns)
}
