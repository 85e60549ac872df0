"""The published folder that `ci/site` makes, and the workflow that uploads it."""

import shutil

import pytest
from command_line import ran
import yaml

from common.program import ROOT


@pytest.fixture
def tree(tmp_path):
    """A tree with the script, the results, the documentation and a page."""
    for name in ("ci/site", "results/schema.json"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    (tmp_path / "build/report/figures").mkdir(parents=True)
    (tmp_path / "build/report/index.html").write_text("the page")
    (tmp_path / "build/docs").mkdir()
    (tmp_path / "build/docs/index.html").write_text("the documentation")
    (tmp_path / "build/report/figures/a.svg").write_text("a figure")
    return tmp_path


def site(tree, *words):
    """Runs ci/site."""
    command = ["bash", str(tree / "ci/site"), *words]
    return ran(*command)


def test_a_site_has_documentation_page_and_results_and_replaces_the_last_one(tree):
    for text in ("an old page", "the page"):
        (tree / "build/report/index.html").write_text(text)
        assert site(tree).returncode == 0
    folder = tree / "build/site"
    assert (folder / "index.html").read_text() == "the documentation"
    assert (folder / "report/index.html").read_text() == "the page"
    found = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    others = {"report/figures/a.svg", "results/schema.json", ".nojekyll"}
    assert found == {"index.html", "report/index.html", *others}
    assert not (tree / "build/site.new").exists()


@pytest.mark.parametrize("part, maker", [("report", "ci/verify"), ("docs", "ci/docs-site")])
def test_without_one_of_its_parts_there_is_no_site(tree, part, maker):
    (tree / f"build/{part}/index.html").unlink()
    done = site(tree, "elsewhere")
    assert done.returncode == 2 and f"build/{part}/index.html is missing; `{maker}`" in done.stderr
    assert not (tree / "elsewhere").exists()


def test_the_workflow_runs_what_is_there_and_uploads_what_it_makes():
    jobs = yaml.safe_load((ROOT / ".github/workflows/pages.yml").read_text())["jobs"]
    assert jobs["deploy"]["needs"] == "site"
    steps = jobs["site"]["steps"]
    scripts = [s["run"].split() for s in steps if s.get("run", "").startswith("bash ")]
    made = ["ci/setup", "ci/verify", "ci/build", "ci/docs-site", "ci/site"]
    assert [words[1] for words in scripts] == made
    assert all((ROOT / words[1]).is_file() for words in scripts)
    (upload,) = (s for s in steps if s.get("uses", "").startswith("actions/upload-pages"))
    assert upload["with"]["path"] == scripts[-1][2]
