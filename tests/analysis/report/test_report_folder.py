"""The folder of a report comes into being whole, or not at all."""

import pytest

from analysis.report import write_report
from data.errors import ElbowroomError, InputError


def everything(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def test_a_report_names_every_file_it_wrote(study_case, tmp_path):
    result = write_report(study_case.table, study_case.fit, tmp_path / "report", study_case.stuck)
    assert result.paths[0].name == "report.html"
    assert set(result.paths) == {path for path in (tmp_path / "report").rglob("*") if path.is_file()}
    assert {path.suffix for path in result.paths} == {".html", ".csv", ".json", ".nc", ".svg", ".png"}


def test_an_earlier_report_is_replaced_and_nothing_of_it_stays(study_case, refused_case, tmp_path):
    out = tmp_path / "report"
    write_report(study_case.table, study_case.fit, out, study_case.stuck)
    write_report(refused_case.table, refused_case.fit, out)
    assert not (out / "stuck.csv").exists()
    assert not list((out / "figures").glob("*stuck*"))
    assert everything(tmp_path) == sorted(["report", *(f"report/{name}" for name in everything(out))])


def test_a_folder_of_other_files_is_refused_and_left_alone(study_case, tmp_path):
    (tmp_path / "thesis.txt").write_text("years of work", encoding="utf-8")
    with pytest.raises(InputError, match=str(tmp_path)):
        write_report(study_case.table, study_case.fit, tmp_path)
    assert everything(tmp_path) == ["thesis.txt"]


def test_a_folder_that_cannot_be_written_leaves_nothing(study_case, tmp_path, monkeypatch):
    def forbidden(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("data.locations.tempfile.mkdtemp", forbidden)
    with pytest.raises(ElbowroomError, match="permission denied") as caught:
        write_report(study_case.table, study_case.fit, tmp_path / "report")
    assert caught.value.exit_code == 1
    assert everything(tmp_path) == []


def test_a_disk_that_fills_up_leaves_nothing(study_case, tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("analysis.figures.style.Drawing.write", full)
    with pytest.raises(ElbowroomError, match="full") as caught:
        write_report(study_case.table, study_case.fit, tmp_path / "report")
    assert "\n" not in str(caught.value)
    assert everything(tmp_path) == []
