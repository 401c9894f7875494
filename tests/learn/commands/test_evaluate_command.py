import csv
import json
import time

import numpy as np
import pytest
from boxy_urdf import write_cabinets

from asset_factory.factory.cli.commands import run
from asset_factory.factory.config import ParticulateConfig
from asset_factory.learn.evaluate import trial as trials
from asset_factory.learn.evaluate.cases import make_case, procedural_requests
from asset_factory.learn.evaluate.listing import real_requests
from asset_factory.learn.evaluate.methods import Method
from asset_factory.learn.objects.export import write_annotation
from asset_factory.sim_checks.processes.isolation import Limits


@pytest.fixture(scope="module")
def cabinets(tmp_path_factory):
    folder = tmp_path_factory.mktemp("cabinets")
    write_cabinets(folder)
    return folder


def evaluate(cabinets, output, *flags):
    given = ["evaluate", "--data", str(cabinets), "--list", str(cabinets / "list.csv")]
    return run([*given, "--half", "both", "--output", str(output), *flags])


def load(output):
    return json.loads((output / "evaluation.json").read_text())


def test_the_same_evaluation_leaves_the_same_bytes(cabinets, tmp_path, capsys):
    for name, workers in (("first", "1"), ("second", "2")):
        flags = ("--pose", "closed", "open", "--workers", workers)
        assert evaluate(cabinets, tmp_path / name, *flags) == 0
    for file in ("evaluation.json", "cases.csv"):
        assert (tmp_path / "first" / file).read_bytes() == (tmp_path / "second" / file).read_bytes()
    assert str(tmp_path) not in (tmp_path / "first" / "evaluation.json").read_text()
    assert "part mIoU" in capsys.readouterr().out
    with (tmp_path / "first" / "cases.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 8
    naive = [row for row in rows if row["method"] == "naive"]
    assert all(float(row["articulated_iou"]) == 0.0 and row["precision"] == "" for row in naive)
    overall = load(tmp_path / "first")["summary"][:2]
    assert [entry["method"] for entry in overall] == ["geometric", "naive"]
    assert overall[0]["objects"] == 4
    mean = np.mean([float(row["part_miou"]) for row in naive])
    assert overall[1]["values"]["part_miou"] == pytest.approx(mean, abs=1e-6)


def test_an_output_that_cannot_be_written_is_refused_at_once(
    cabinets, tmp_path, capsys, monkeypatch
):
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(trials, "run_trials", None)
    assert evaluate(cabinets, tmp_path / "file") == 2
    assert "--output: " in capsys.readouterr().err


def first_of(cabinets):
    """The name of the first case, and the truth about it."""
    request, _ = real_requests(cabinets, None, cabinets / "list.csv")
    return request.name, make_case(request)


def test_predictions_are_read_from_files_and_missing_ones_are_scored_as_naive(
    cabinets, tmp_path, capsys
):
    name, truth = first_of(cabinets)
    given = tmp_path / "given"
    given.mkdir()
    write_annotation(truth, given / f"{name}.npz")
    flags = ("--method", "naive", "predictions", "--predictions", str(given))
    assert evaluate(cabinets, tmp_path / "out", *flags) == 0
    lines = {(line["method"], line["case"]): line for line in load(tmp_path / "out")["cases"]}
    read = lines["predictions", "made__one__one--closed-front"]
    assert read["failure"] == ""
    assert read["values"]["articulated_iou"] == read["values"]["part_miou"] == 1.0
    lost = lines["predictions", "made__two__two--closed-front"]
    assert lost["failure"].startswith("missing_file: ")
    assert lost["values"] == lines["naive", "made__two__two--closed-front"]["values"]
    assert "missing_file" in capsys.readouterr().err
    summary = load(tmp_path / "out")["summary"]
    overall = {each["method"]: each for each in summary if each["by"] == "overall"}
    assert overall["predictions"]["failures"] == 1


def test_meshes_are_written_in_the_order_that_predictions_speak_of(cabinets, tmp_path):
    assert evaluate(cabinets, tmp_path / "unused", "--meshes", str(tmp_path / "meshes")) == 0
    name, truth = first_of(cabinets)
    lines = (tmp_path / "meshes" / f"{name}.obj").read_text().split("\n")
    vertices = np.array([line.split()[1:] for line in lines if line.startswith("v ")], float)
    faces = np.array([line.split()[1:] for line in lines if line.startswith("f ")], int) - 1
    assert np.array_equal(vertices, truth.mesh.vertices)
    assert np.array_equal(faces, truth.mesh.faces)
    assert not (tmp_path / "unused").exists()


def test_the_published_conventions_and_procedural_objects(tmp_path):
    asked = "--set procedural --category cabinet --seeds 1 --convention release --points 500"
    flags = [*asked.split(), "--method", "naive"]
    assert run(["evaluate", "--output", str(tmp_path), *flags]) == 0
    data = load(tmp_path)
    assert data["settings"]["points"] == 500
    assert -1.0 <= data["summary"][0]["values"]["articulated_giou"] <= 1.0


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (("--method", "oracle"), "no method 'oracle'"),
        (("--method", "predictions"), "want the folder of <case>.npz files"),
        (
            ("--method", "particulate", "--checkpoint", "nowhere.safetensors"),
            "nowhere.safetensors: no such file",
        ),
        (("--category", "spaceship"), "none of these objects is a 'spaceship'"),
        (("--timeout", "0"), "--timeout must be"),
        (("--repeats", "0"), "--repeats must be at least 1, not 0"),
    ],
)
def test_wrong_usage_says_what_would_be_right(cabinets, tmp_path, capsys, flags, message):
    assert evaluate(cabinets, tmp_path / "out", *flags) == 2
    assert message in capsys.readouterr().err


def hangs(trial):
    time.sleep(60.0)


def test_a_method_that_hangs_is_cut_off_and_not_scored(monkeypatch):
    monkeypatch.setattr(trials, "score_trial", hangs)
    (request,) = procedural_requests(("cabinet",), (0,))
    trial = trials.Trial(request, Method("naive", ParticulateConfig()))
    row = next(trials.run_trials([trial], 1, Limits(wall_s=2.0)))
    assert row.failure == "timeout: no answer within 2 s"
    assert row.score is None


def test_folders_are_evaluated_without_a_list(cabinets, tmp_path):
    code = run(["evaluate", "--set", "folder", "--data", str(cabinets), "--output", str(tmp_path)])
    assert code == 0
    assert (load(tmp_path)["settings"]["set"], load(tmp_path)["settings"]["cases"]) == ("folder", 2)
