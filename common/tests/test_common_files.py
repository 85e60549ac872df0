"""Atomic writing of files, and validated reading of JSON and TOML."""

import json
import os

import pytest

from common.errors import InputError
from common.files import (
    new_file,
    read_json,
    read_toml,
    require_writable,
    write_json,
    write_whole,
    writing,
)


def test_a_text_takes_the_place_of_the_old_one(tmp_path):
    file = tmp_path / "x.txt"
    for text in ("old", "Fuß\n"):
        write_whole(file, text)
        assert file.read_text(encoding="utf-8") == text
    assert list(tmp_path.iterdir()) == [file]
    assert file.stat().st_mode & 0o777 == 0o644


@pytest.mark.parametrize(
    "error, kind",
    [(OSError(28, "No space left on device"), InputError), (KeyError("a key"), KeyError)],
)
def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path, error, kind):
    file = tmp_path / "x.h5"
    file.write_text("old")
    with pytest.raises(kind, match="x.h5: cannot be written: No space left|a key"):
        with new_file(file) as temporary:
            temporary.write_text("half")
            raise error
    assert file.read_text() == "old" and list(tmp_path.iterdir()) == [file]


def test_a_failed_replacement_leaves_the_old_file(tmp_path, monkeypatch):
    file = tmp_path / "x.txt"
    file.write_text("old")

    def refuse(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(InputError, match="x.txt: cannot be written: No space left"):
        write_whole(file, "new")
    assert file.read_text() == "old" and list(tmp_path.iterdir()) == [file]


def test_a_link_is_written_through(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "there" / "x.txt")
    write_whole(tmp_path / "link", "text")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "there" / "x.txt").read_text() == "text"


def test_places_that_cannot_be_written(tmp_path):
    require_writable(tmp_path / "x.h5")
    with pytest.raises(InputError, match="none/x.h5: cannot be written: the folder .*none does"):
        require_writable(tmp_path / "none" / "x.h5")
    with pytest.raises(InputError, match="cannot be written: must be a file"):
        require_writable(tmp_path)
    for place in (tmp_path / "none" / "x.txt", tmp_path):
        with pytest.raises(InputError, match=f"{place}: cannot be written: "):
            write_whole(place, "text")
    assert not list(tmp_path.iterdir())


def test_errors_of_others_who_write_name_their_file(tmp_path):
    with pytest.raises(InputError, match="none/a.svg: cannot be written: No such file"):
        with writing(tmp_path):
            (tmp_path / "none" / "a.svg").write_text("text")
    with pytest.raises(InputError, match="figures: cannot be written: a reason"):
        with writing("figures"):
            raise OSError("a reason")


def test_documents_come_back(tmp_path):
    document = {"records": [{"x": 0.1}, None], "name": "Fuß"}
    write_json(tmp_path / "x.json", document)
    assert read_json(tmp_path / "x.json") == document
    with pytest.raises(ValueError):
        write_json(tmp_path / "x.json", {"x": float("nan")})
    assert json.loads((tmp_path / "x.json").read_text()) == document


@pytest.mark.parametrize(
    "content, message",
    [
        (b"[]", "x.json: must be an object, not list"),
        (b"{", "x.json: not a JSON file: "),
        (b"\xff", "x.json: not a JSON file: "),
        (None, "x.json: cannot be read: No such file or directory; make it with a command"),
    ],
)
def test_invalid_documents_are_refused(tmp_path, content, message):
    if content is not None:
        (tmp_path / "x.json").write_bytes(content)
    with pytest.raises(InputError, match=message):
        read_json(tmp_path / "x.json", "a command")


def test_tables(tmp_path):
    (tmp_path / "x.toml").write_text('[case]\nname = "Fuß"\n', encoding="utf-8")
    assert read_toml(tmp_path / "x.toml") == {"case": {"name": "Fuß"}}
    for content in (b"[case\n", b"\xff"):
        (tmp_path / "x.toml").write_bytes(content)
        with pytest.raises(InputError, match="x.toml: not a TOML file: "):
            read_toml(tmp_path / "x.toml")
