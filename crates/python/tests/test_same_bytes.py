"""The same input gives the same bytes as the command."""

import json

import pytest
import simgap
from conftest import DEMO, command_of


def files_of(folder):
    return {str(f.relative_to(folder)): f.read_bytes() for f in folder.rglob("*") if f.is_file()}


@pytest.fixture(scope="module")
def by_python():
    train = [DEMO / "train-1.csv", DEMO / "train-2.csv"]
    model = simgap.Model.from_file(DEMO / "model.toml")
    return simgap.diagnose(model, train, check=[DEMO / "check.csv"], progress=False)


def test_the_json_is_that_of_the_command(by_command, by_python):
    assert by_python.to_json() == (by_command / "diagnosis.json").read_text()
    assert by_python.to_dict() == json.loads(by_python.to_json())


def test_the_folder_is_that_of_the_command(by_command, by_python, tmp_path):
    by_python.save(tmp_path / "result")
    saved, wanted = files_of(tmp_path / "result"), files_of(by_command)
    assert sorted(saved) == sorted(wanted)
    differ = [name for name in wanted if saved[name] != wanted[name]]
    assert differ == []


def test_what_was_read_before_gives_the_same(by_command):
    records = [simgap.read(DEMO / name) for name in ("train-1.csv", "train-2.csv", "check.csv")]
    model = simgap.Model.from_toml((DEMO / "model.toml").read_text())
    d = simgap.diagnose(model, records[:2], records[2], progress=False)
    assert d.to_json() == (by_command / "diagnosis.json").read_text()


def test_the_answer_is_told_part_by_part(by_python):
    d = by_python
    assert d.status == "effect" and d.complete in (True, False)
    kinds = {effect.kind: effect for effect in d.effects}
    friction = kinds["coulomb_friction"]
    assert friction.at == {"between": ["mold", "ground"]}
    assert 0.5 < friction.probability <= 1.0
    parameter = friction.parameters["friction_force_n"]
    low, high = parameter.ci95
    assert low < parameter.value < high
    assert 0.9 < d.gap.closed <= 1.0 and d.gap.metric == "nrmse"
    assert abs(sum(band.share for band in d.where.bands)) <= 1.0 + 1e-9
    assert d.to_html().startswith("<!DOCTYPE html>")
    assert "Coulomb friction" in str(d) and "coulomb_friction" in repr(d)
    assert "<iframe" in d._repr_html_()


def test_the_corrected_model_predicts_what_the_answer_predicts(by_python):
    predictions = by_python.predictions
    assert list(predictions) == ["check"]
    table = predictions["check"]
    assert list(table.columns)[0] == "t [s]" and len(table) > 100
    corrected = by_python.corrected
    again = simgap.simulate(corrected, DEMO / "check.csv")
    channel = corrected.outputs[0]
    (column,) = [name for name in table.columns if name.startswith(f"{channel} corrected")]
    (simulated,) = [name for name in again.columns if name.startswith(f"{channel} [")]
    spread = table[column].std()
    assert abs(table[column] - again[simulated]).max() < 1e-3 * spread


def test_simulations_are_those_of_the_command(tmp_path):
    out = tmp_path / "predicted.csv"
    command_of("simulate", DEMO / "model.toml", "--record", DEMO / "check.csv", "--out", out)
    header, *rows = out.read_text().splitlines()
    table = simgap.simulate(DEMO / "model.toml", DEMO / "check.csv")
    assert list(table.columns) == header.split(",")
    by_command = [[float(cell) for cell in row.split(",")] for row in rows]
    assert table.to_numpy().tolist() == by_command


def test_tables_are_those_of_the_command():
    told = command_of("modes", DEMO / "model.toml", "--format", "json").stdout
    found = simgap.modes(DEMO / "model.toml")
    assert found.to_json() == told
    assert found[0].natural_freq_hz > 0.0 and len(found.to_pandas()) == len(found)
    told = json.loads(command_of("effects", "--format", "json").stdout)
    assert list(simgap.effects()) == [one["kind"] for one in told["effects"]]
    assert simgap.effects("tone_pickup")["tone_pickup"].family == "measurement"


def test_comparisons_are_those_of_the_command(tmp_path):
    predicted = tmp_path / "predicted.csv"
    command_of("simulate", DEMO / "model.toml", "--record", DEMO / "check.csv", "--out", predicted)
    words = ["--measured", DEMO / "check.csv", "--simulated", predicted]
    command_of("compare", *words, "--out", tmp_path / "command")
    found = simgap.compare(DEMO / "check.csv", predicted, progress=False)
    found.save(tmp_path / "python")
    assert files_of(tmp_path / "python") == files_of(tmp_path / "command")
    assert found.channels[0].nrmse > 0.0 and len(found.traces) > 100
    table = simgap.simulate(DEMO / "model.toml", DEMO / "check.csv")
    simulated = simgap.Record(table, name="predicted.csv")
    again = simgap.compare(simgap.read(DEMO / "check.csv"), simulated, progress=False)
    assert again.to_json() == found.to_json()
