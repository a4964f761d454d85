"""A law of the user's: built, listed, named by a diagnosis, simulated."""

import numpy as np
import pytest
import simgap
from conftest import ROOT

SLIDE = ROOT / "fixtures" / "greased-slide"
PARAMETERS = {
    "c": {"unit": "N", "usual": 10.0},
    "v0": {"unit": "m/s", "usual": 0.1},
    "k": {"unit": "1/m^2", "lower": 0.0, "upper": 50000.0},
}


def slide():
    built = simgap.Model("slide").mass("slide", 20.0)
    built = built.spring("spring", ("slide", "ground"), stiffness=20000.0)
    built = built.damper("guide", ("slide", "ground"), damping=60.0)
    built = built.input("force", at="slide").output("position", at="slide")
    return built.law(
        "grease", "c * tanh(v / v0) * (1 + k * d^2)", PARAMETERS, between=("slide", "ground")
    )


def test_a_law_is_named_and_simulated():
    model = slide()
    assert simgap.Model.from_toml(model.to_toml()) == model
    kinds = simgap.effects(model=model)
    assert len(kinds) == len(simgap.effects()) + 1
    assert kinds["grease"].equation == "F = c * tanh(v / v0) * (1 + k * d^2)"
    check = simgap.read(SLIDE / "check.csv")
    d = simgap.diagnose(model, [SLIDE / "train.csv"], [check], progress=False)
    grease = d.effects[0]
    assert grease.kind == "grease" and grease.probability > 0.9
    for (name, parameter), truth in zip(grease.parameters.items(), [30.0, 0.05, 6000.0]):
        assert parameter.value == pytest.approx(truth, rel=0.02)
        assert parameter.unit == PARAMETERS[name]["unit"]
    assert "c * tanh(v / v0)" in d.corrected.to_toml()
    again = simgap.simulate(d.corrected, check)
    told = d.predictions["check"]["position corrected [m]"]
    assert np.allclose(again["position [m]"], told, rtol=0.0, atol=1e-12)


def test_what_is_wrong_with_a_law_is_told_in_one_line():
    with pytest.raises(simgap.SimgapError, match='^model: line .* unknown symbol "w"'):
        slide().law("other", "c * w", {"c": {"unit": "N", "usual": 1.0}}).to_toml()
    with pytest.raises(simgap.SimgapError, match="needed is another name"):
        slide().law("backlash", "c * v", {"c": {"unit": "N", "usual": 1.0}}).to_toml()
