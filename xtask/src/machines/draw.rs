//! A machine whose outputs are a little noisier.

use std::fs;
use std::path::{Path, PathBuf};

use simgap_model::Model;
use simgap_rigs::rng::Rng;

use super::error::MachinesError;
use crate::asked::{at, training_records};

/// Writes a machine with white noise on its outputs, of this share of the standard deviation of each in each record.
pub(super) fn draw(from: &Path, to: &Path, seed: &str, share: f64) -> Result<(), MachinesError> {
    fs::create_dir_all(to).map_err(at(to))?;
    let path = from.join("model.toml");
    let text = fs::read_to_string(&path).map_err(at(&path))?;
    let model = Model::from_toml(&text).map_err(|source| MachinesError::Model {
        path: path.display().to_string(),
        source,
    })?;
    write(&to.join("model.toml"), &text)?;
    let outputs: Vec<&str> = model.outputs.iter().map(|o| o.channel.as_str()).collect();
    let mut records: Vec<PathBuf> = training_records(from)?;
    records.push(from.join("check.csv"));
    for record in records {
        let file = record.file_name().unwrap_or_default().to_string_lossy();
        let mut rng = Rng::new(&format!("{seed} {file}"));
        let text = fs::read_to_string(&record).map_err(at(&record))?;
        let noisy = with_noise(&text, &outputs, share, &mut rng);
        let noisy = noisy.map_err(|(line, channel)| MachinesError::NoNumber {
            path: record.display().to_string(),
            line,
            channel,
        })?;
        write(&to.join(&*file), &noisy)?;
    }
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<(), MachinesError> {
    Ok(fs::write(path, text).map_err(at(path))?)
}

/// A table of comma-separated values with noise on some columns; the line and the column that hold no number. Empty cells stay empty.
fn with_noise(
    text: &str,
    outputs: &[&str],
    share: f64,
    rng: &mut Rng,
) -> Result<String, (usize, String)> {
    let mut lines: Vec<Vec<String>> = text
        .lines()
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect();
    for output in outputs {
        let wrong = |line: usize| (line + 1, (*output).to_owned());
        let named = |cell: &String| cell.split(" [").next().map(str::trim) == Some(*output);
        let header = lines
            .first()
            .and_then(|header| header.iter().position(named));
        let column = header.ok_or_else(|| wrong(0))?;
        let mut values = vec![];
        for (number, line) in lines.iter().enumerate().skip(1) {
            let cell = line.get(column).map_or("", |cell| cell.trim());
            if !cell.is_empty() {
                values.push((number, cell.parse::<f64>().map_err(|_| wrong(number))?));
            }
        }
        let count = values.len().max(1) as f64;
        let mean = values.iter().map(|(_, value)| value).sum::<f64>() / count;
        let square = values.iter().map(|(_, value)| (value - mean).powi(2));
        let std = (square.sum::<f64>() / count).sqrt();
        for (number, value) in values {
            lines[number][column] = (value + share * std * rng.normal()).to_string();
        }
    }
    Ok(lines.iter().map(|line| line.join(",") + "\n").collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_noise_is_on_the_outputs_alone() {
        let rows: String = (0..4000)
            .map(|k| format!("{k},{},{}\n", (0.1 * f64::from(k)).sin(), 0.5))
            .collect();
        let text = format!("t [s],y [m],u [N]\n{rows}");
        let mut rng = Rng::new("noise");
        let noisy = with_noise(&text, &["y"], 0.01, &mut rng).unwrap();
        let of = |text: &str, column: usize| -> Vec<f64> {
            let cells = text.lines().skip(1).map(|line| line.split(',').nth(column));
            cells.map(|cell| cell.unwrap().parse().unwrap()).collect()
        };
        assert_eq!(of(&text, 2), of(&noisy, 2));
        let [before, after] = [of(&text, 1), of(&noisy, 1)];
        let square = before.iter().zip(&after).map(|(a, b)| (a - b).powi(2));
        let rms = (square.sum::<f64>() / 4000.0).sqrt();
        assert!((rms / (0.01 / 2f64.sqrt()) - 1.0).abs() < 0.05, "{rms}");
        let wrong = with_noise("t [s],y [m]\n0,a\n", &["y"], 0.01, &mut rng);
        assert_eq!(wrong, Err((2, "y".into())));
        let missing = with_noise(&text, &["z"], 0.01, &mut rng);
        assert_eq!(missing, Err((1, "z".into())));
    }
}
