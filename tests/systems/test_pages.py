"""Links, commands and paths in README and docs lead somewhere, and docs/index.md lists every page."""

import ast
import re
from pathlib import Path
from types import ModuleType

import pytest

import contact_core
from system_models import master, runs

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]
FOLDERS = ("benchmarks", "contact_core", "docs", "fmu_src", "system_models", "tests")


def headings(text: str) -> set[str]:
    """Return the headings of a page as links name them."""
    titles = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w -]", "", title.lower()).strip().replace(" ", "-") for title in titles}


def resolves(page: Path, target: str) -> bool:
    """Return whether a link of a page leads to a file, and to a heading of it if it names one."""
    if target.startswith("https://"):
        return True
    name, _, heading = target.partition("#")
    file = page.parent / name if name else page
    return file.exists() and (not heading or heading in headings(file.read_text("utf-8")))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_commands_and_paths_of_a_page_exist(page: Path) -> None:
    text = page.read_text("utf-8")
    links = re.findall(r"\]\(([^)\s]+)\)", text)
    assert [target for target in links if not resolves(page, target)] == []
    files = [f"{name.replace('.', '/')}.py" for name in re.findall(r"python -m (benchmarks[\w.]+\w)", text)]
    files += re.findall(rf"(?<![\w/.])((?:{'|'.join(FOLDERS)})/[\w/.-]*\w)", text)
    if page.parent == DOCS / "measured":  # sections name files of the code that they were measured with
        return
    new = [Path(name) for name in re.findall(r"^`(\S+)`, new:$", text, re.MULTILINE)]  # files of examples
    made = {str(path) for name in new for path in (name, *name.parents)}
    assert [name for name in files if not (ROOT / name).exists() and name not in made] == []


@pytest.mark.parametrize(
    ("target", "found"),
    [
        ("docs/index.md", True),
        ("docs/index.md#nowhere", False),
        ("docs/nowhere.md", False),
        ("#two-commands", True),
        ("https://example.org/nowhere", True),
    ],
)
def test_a_link_that_leads_nowhere_is_found(target: str, found: bool) -> None:
    assert resolves(ROOT / "README.md", target) is found


def test_the_index_lists_every_page_once() -> None:
    index = DOCS / "index.md"
    listed = re.findall(r"^- \[.*?\]\(([^)]+\.md)\)", index.read_text("utf-8"), re.MULTILINE)
    pages = [str(page.relative_to(DOCS)) for page in PAGES if DOCS in page.parents and page != index]
    assert sorted(listed) == sorted(pages)


@pytest.mark.parametrize("package", [contact_core, master, runs], ids=lambda package: package.__name__)
def test_the_page_of_the_api_has_every_public_name(package: ModuleType) -> None:
    text = (DOCS / "api.md").read_text("utf-8")
    listed = set(re.findall(r"auto(?:class|function):: (\w+)", text))
    errors = {name for name in package.__all__ if name.endswith("Error")}  # by their module
    assert set(package.__all__) - errors - listed == set()


def definitions(path: Path) -> set[str]:
    """Return the classes and functions of a module, methods as Class.method."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ClassDef):
            found |= {f"{node.name}.{inner.name}" for inner in node.body if isinstance(inner, ast.FunctionDef)}
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            found.add(node.name)
    return found


def test_every_equation_is_where_the_page_of_physics_says() -> None:
    text = (DOCS / "physics.md").read_text("utf-8").replace("\n  ", " ")
    places = re.findall(r"`((?:contact_core|system_models)/[\w/]+\.py)`((?:, `[\w.]+`)*)", text)
    assert len(places) > 50
    for file, names in places:
        assert set(re.findall(r"`([\w.]+)`", names)) <= definitions(ROOT / file), file


def test_benchmarks_import_nothing_from_tests() -> None:
    ours = {"benchmarks", "contact_core", "fmu_src", "system_models"}
    flat = {path.stem for path in (ROOT / "tests").rglob("*.py")} - ours
    for path in (ROOT / "benchmarks").rglob("*.py"):
        nodes = list(ast.walk(ast.parse(path.read_text("utf-8"))))
        names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
        names |= {node.module or "" for node in nodes if isinstance(node, ast.ImportFrom) and not node.level}
        assert names & flat == set(), path
        assert "sys.path.insert" not in path.read_text("utf-8"), path
