"""The README's lines on Python, word for word, and a notebook."""

import json
import os
import subprocess
import sys

from conftest import readme_blocks


def test_the_readme_prints_what_it_shows(in_axis_folder):
    (code,) = readme_blocks("python")
    (shown,) = readme_blocks("text")
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    assert found.stdout == shown
    assert (in_axis_folder / "result" / "report.html").is_file()


def test_a_notebook_shows_the_report_and_the_machine(in_axis_folder):
    cells = [
        "import simgap\nmodel = simgap.Model.from_file('axis.toml')\nmodel",
        "d = simgap.diagnose(model, ['run1.csv'], check=['run3.csv'], budget_s=0)\nd",
        "d.predictions['run3'].head()",
    ]
    code = [
        {
            "cell_type": "code",
            "id": f"c{k}",
            "metadata": {},
            "execution_count": None,
            "outputs": [],
            "source": text,
        }
        for k, text in enumerate(cells)
    ]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    notebook = {"nbformat": 4, "nbformat_minor": 5, "metadata": kernel, "cells": code}
    (in_axis_folder / "look.ipynb").write_text(json.dumps(notebook))
    words = [
        "-m",
        "nbconvert",
        "--to",
        "notebook",
        "--execute",
        "--output",
        "seen.ipynb",
        "look.ipynb",
    ]
    kept = {**os.environ, "JUPYTER_PATH": os.path.join(sys.prefix, "share", "jupyter")}
    found = subprocess.run([sys.executable, *words], capture_output=True, text=True, env=kept)
    assert found.returncode == 0, found.stderr
    seen = json.loads((in_axis_folder / "seen.ipynb").read_text())
    html = [
        "".join(output["data"].get("text/html", ""))
        for cell in seen["cells"]
        for output in cell["outputs"]
        if "data" in output
    ]
    html = [text for text in html if text]
    assert html[0].count("<svg") == 2 and "bellows" in html[0]
    assert "<iframe" in html[1] and "simgap" in html[1]
    assert "<table" in html[2]
    keep = os.environ.get("SIMGAP_NOTEBOOK_HTML")
    if keep:
        words = ["-m", "nbconvert", "--to", "html", "--output", keep, "seen.ipynb"]
        subprocess.run([sys.executable, *words], check=True, env=kept)
