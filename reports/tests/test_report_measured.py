"""Files of other commands: what is read, what may be absent, and what is rejected."""

import pytest

from make_report import main
from sandglass_report.measured import OWN_MESH, read_measured
from sandglass_report.points import Point
from sandglass_report.replication import table_1, table_2


def read(data):
    """The data set's optional files that exist."""
    names = ("bench.json", "flops.json", "curves", "maps", "kept-maps")
    return read_measured(*(data.folder / name for name in names))


def test_what_is_absent_is_named_with_its_command(data):
    found = read(data)
    assert not (found.rungs or found.steps or found.counts or found.maps)
    assert all(source.facts is None for source in found.sources)
    commands = " ".join(source.command for source in found.sources)
    for word in ("bench --threads", "flops", "reports/curves", "stability CASE"):
        assert word in commands


def test_only_packs_on_one_thread_are_timed_steps(data):
    records = [data.timing("tl-none", 10.0)]
    records += [data.timing("tl-none", 20.0, kernel="scalar"), data.timing("a", 5.0, threads=2)]
    records += [data.timing("b", None)]
    data.write("bench.json", {"records": records})
    assert [(step.method, step.ns) for step in read(data).steps] == [("tl-none", 10.0)]


def test_table_1_counts_the_papers_form_and_the_kernels(data):
    records = [data.count("tl-perturbation", 360, form="paper"), data.count("tl-perturbation", 168)]
    records += [data.count("tl-perturbation", 598, "element"), data.count("ul-perturbation", 437)]
    data.write("flops.json", {"records": records})
    total, updated = table_1(read(data).counts)
    assert (total.paper, total.as_written, total.control, total.element) == (360, 360, 168, 598)
    assert (updated.paper, updated.as_written, updated.control) == (1585, None, 437)
    assert updated.element is None


def timed(method, ns, **changed):
    """A point of the main chart on the paper's ellipsoid."""
    known = {"case": "ellipsoid-indentation", "kappa": None, "as_it_comes": True, "accuracy": None}
    known |= {"precision": "double", "mesh": OWN_MESH, "elements": 2200, "finding": "", "ok": True}
    return Point(method=method, ns=ns, step=1e-9 * ns * 2200, **(known | changed))


def test_table_2_takes_the_charts_step_of_the_whole_mesh_in_double_on_the_ellipsoid():
    points = [timed("tl-perturbation", 999.0, precision="float")]
    points += [timed("tl-perturbation", 999.0, case="column")]
    points += [timed("tl-perturbation", 999.0, mesh="coarser")]
    points += [timed("ul-enhanced", 999.0, elsewhere="another machine")]
    points += [timed("tl-perturbation", 50.0), timed("ul-perturbation", 150.0)]
    first, second, third = table_2(points)
    assert first.ours == pytest.approx(50e-6 * 2200)  # ms
    assert second.our_ratio == pytest.approx(3.0)
    assert second.paper_ratio == pytest.approx(10.6 / 2.1)
    assert third.ours is None and third.our_ratio is None


def a_map(case, revision="abc"):
    """A document of sandglass stability with no cells."""
    return {"case": case, "limit": 0.01, "revision": revision, "maps": []}


def test_kept_maps_stand_in_for_cases_that_were_not_swept_anew(data):
    data.write("maps/column.json", a_map("column", "new"))
    data.write("kept-maps/column.json", a_map("column", "old"))
    data.write("kept-maps/twist.json", a_map("twist", "old"))
    found = {document["case"]: document["revision"] for document in read(data).maps}
    assert found == {"column": "new", "twist": "old"}


@pytest.mark.parametrize(
    ("name", "document", "words"),
    [
        ("bench.json", [], ("must be an object",)),
        ("bench.json", {"records": 1}, ("records = 1", "a list")),
        ("bench.json", {"records": [{"kernel": "pack", "threads": 1}]}, ("[0].ns_per_element",)),
        ("flops.json", {"records": [{"method": 1}]}, ("records[0].method = 1", "a text")),
        ("curves/a.json", {"case": "c"}, ("reference", "missing")),
        ("maps/a.json", {"case": "c"}, ("limit", "missing")),
        ("kept-maps/a.json", {"case": "c"}, ("limit", "missing")),
    ],
)
def test_what_is_broken_is_refused_with_file_and_key(data, capsys, name, document, words):
    data.write(name, document)
    assert main(data.arguments) == 2
    told = capsys.readouterr().err
    assert told.startswith("error: ") and told.count("\n") == 1
    for word in (name, *words):
        assert word in told
    assert not data.page.exists()
