from __future__ import annotations

import json
import os
import subprocess
import sys
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from django.core.management import CommandError, call_command

MANAGE = Path(__file__).resolve().parents[2] / "manage.py"


def written(folder: Path, name: str, text: str) -> str:
    (folder / name).write_text(text)
    return str(folder / name)


def evaluated(*arguments: str) -> dict[str, Any]:
    output = StringIO()
    call_command("evaluate", *arguments, "--json", stdout=output)
    result: dict[str, Any] = json.loads(output.getvalue())
    return result


@pytest.fixture
def files(tmp_path: Path) -> tuple[str, str]:
    """One exact (frame 0), one 12 columns = 0.3 m off, one missed; one extra (frame 5)."""
    return (
        written(tmp_path, "gt.txt", "0 100 100\n0 200 100\n0 300 100\n"),
        written(tmp_path, "found.txt", "0 100 100\n0 212 100\n5 100 100\n"),
    )


def test_json_is_one_object_with_scores_as_fractions_and_counts(files: tuple[str, str]) -> None:
    assert evaluated(*files, "--step", "0.025") == {
        "moda": pytest.approx(1 / 3),
        "modp": pytest.approx(0.7),
        "precision": pytest.approx(2 / 3),
        "recall": pytest.approx(2 / 3),
        "radius": 0.5,
        "frames": 2,
        "truth": 3,
        "found": 3,
        "matched": 2,
        "missed": 1,
        "extra": 1,
    }


def test_the_radius_is_in_metres(files: tuple[str, str]) -> None:
    assert evaluated(*files, "--step", "0.025", "--radius", "0.3")["matched"] == 1
    assert evaluated(*files, "--step", "0.025", "--radius", "0.301")["matched"] == 2


def test_the_step_turns_columns_into_metres(files: tuple[str, str]) -> None:
    assert evaluated(*files, "--step", "0.05")["matched"] == 1


def test_scores_are_printed_for_people_too(files: tuple[str, str]) -> None:
    output = StringIO()
    call_command("evaluate", *files, "--step", "0.025", stdout=output)
    printed = dict(line.split() for line in output.getvalue().splitlines())
    assert (printed["moda"], printed["matched"]) == ("0.3333", "2")


def test_detections_that_found_nobody_are_scored(tmp_path: Path, files: tuple[str, str]) -> None:
    result = evaluated(files[0], written(tmp_path, "none.txt", ""), "--step", "0.025")
    assert (result["moda"], result["recall"], result["modp"], result["precision"]) == (0.0, 0.0, None, None)


@pytest.mark.parametrize("nobody", ["", "\n", "# frame column row\n\n"])
def test_what_is_not_defined_without_truth_is_null(
    tmp_path: Path, files: tuple[str, str], nobody: str
) -> None:
    result = evaluated(written(tmp_path, "none.txt", nobody), files[1], "--step", "0.025")
    assert (result["moda"], result["modp"], result["precision"], result["recall"]) == (None, None, 0.0, None)
    assert (result["truth"], result["extra"]) == (0, 3)


@pytest.mark.parametrize("identities", [[], ["--identities"]])
def test_nobody_against_nobody_is_valid_json(tmp_path: Path, identities: list[str]) -> None:
    none = written(tmp_path, "none.txt", "")
    output = StringIO()
    call_command("evaluate", none, none, "--step", "0.025", "--json", "--curve", *identities, stdout=output)

    def refuse(word: str) -> None:
        raise AssertionError(f"{word} is no JSON")

    result = json.loads(output.getvalue(), parse_constant=refuse)
    assert (result["moda"], result["frames"]) == (None, 0)


def test_more_mistakes_than_people_make_moda_negative(tmp_path: Path) -> None:
    truth = written(tmp_path, "gt.txt", "0 0 0\n")
    found = written(tmp_path, "found.txt", "0 100 0\n0 200 0\n5 0 0\n")
    assert evaluated(truth, found, "--step", "0.025")["moda"] == -3.0


def test_a_frame_that_one_file_lacks_counts(tmp_path: Path) -> None:
    truth = written(tmp_path, "gt.txt", "0 0 0\n5 0 0\n")
    found = written(tmp_path, "found.txt", "0 0 0\n10 0 0\n")
    result = evaluated(truth, found, "--step", "0.025")
    assert (result["frames"], result["matched"], result["missed"], result["extra"]) == (3, 1, 1, 1)


def test_the_curve_over_the_radius_is_printed_when_asked_for(files: tuple[str, str]) -> None:
    curve = evaluated(*files, "--step", "0.025", "--curve")["curve"]
    assert [(each["radius"], each["recall"]) for each in curve[4:7]] == [
        (0.25, pytest.approx(1 / 3)),
        (0.3, pytest.approx(1 / 3)),  # nearer than the radius, not as near
        (0.35, pytest.approx(2 / 3)),
    ]
    output = StringIO()
    call_command("evaluate", *files, "--step", "0.025", "--curve", stdout=output)
    assert len(output.getvalue().splitlines()) == 11 + 2 + 20


def test_identities_are_compared_when_asked_for(tmp_path: Path) -> None:
    truth = written(tmp_path, "gt.txt", "0 1 1 1\n5 1 1 1\n")
    found = written(tmp_path, "found.txt", "0 1 1 8\n5 1 1 9\n")
    result = evaluated(truth, found, "--step", "0.025", "--identities")
    assert (result["moda"], result["idf1"], result["mota"], result["switches"]) == (1.0, 0.5, 0.5, 1)
    assert result["hota"] == pytest.approx(0.5**0.5)


def test_wrong_lines_of_both_files_are_all_reported_and_nothing_is_computed(tmp_path: Path) -> None:
    truth = written(tmp_path, "gt.txt", "0 1 2\n0 x 2\n")
    found = written(tmp_path, "found.txt", "0 1\n0 1 2\n0 1 2 3\n")
    output = StringIO()
    with pytest.raises(CommandError) as caught:
        call_command("evaluate", truth, found, "--step", "0.025", "--json", stdout=output)
    _, *problems = str(caught.value).splitlines()
    assert [problem.split(": ")[:2] for problem in problems] == [
        [truth, "line 2"],
        [found, "line 1"],
        [found, "line 3"],
    ]
    assert output.getvalue() == ""


@pytest.mark.parametrize("option", ["--step", "--radius"])
@pytest.mark.parametrize("value", ["0", "-1", "nan", "inf"])
def test_lengths_that_are_none_are_refused(files: tuple[str, str], option: str, value: str) -> None:
    with pytest.raises(CommandError, match=f"{option} must be a positive number of metres"):
        call_command("evaluate", *files, "--step=0.025", f"{option}={value}")


def test_wrong_lines_end_the_process_with_code_1(tmp_path: Path) -> None:
    bad = written(tmp_path, "bad.txt", "0 1\n")
    process = subprocess.run(
        [sys.executable, str(MANAGE), "evaluate", bad, bad, "--step", "0.025"], capture_output=True, text=True
    )
    assert (process.returncode, process.stdout) == (1, "")
    assert f"{bad}: line 1: 2 values instead of 3" in process.stderr


@pytest.mark.parametrize(
    "variables",
    [
        {},
        {"DEBUG": "false"},
        {"DEBUG": "true"},
        {"DATA_DIR": "/none", "DATABASE_URL": "postgres://u:p@none/x"},
    ],
)
def test_neither_a_key_nor_a_database_is_needed(files: tuple[str, str], variables: dict[str, str]) -> None:
    process = subprocess.run(
        [sys.executable, str(MANAGE), "evaluate", *files, "--step", "0.025", "--json"],
        capture_output=True,
        text=True,
        env={"PATH": os.environ["PATH"], **variables},
    )
    assert process.returncode == 0, process.stderr
    assert json.loads(process.stdout)["matched"] == 2


def test_the_published_ground_truth_agrees_with_itself(shared_data: Path) -> None:
    truth = str(shared_data / "wildtrack" / "positions_0000-0995.txt")
    result = evaluated(truth, truth, "--step", "0.025")
    assert (result["moda"], result["modp"], result["truth"], result["frames"]) == (1.0, 1.0, 4785, 200)
