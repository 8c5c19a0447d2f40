"""What README and guide say is run: Python, commands, the format; links lead somewhere."""

import json
import re
import shlex
from pathlib import Path

import pytest

from studio.cli import main
from studio.engine.live.access import Address, check_address
from studio.engine.sources import read_skeletons
from studio.panels import hotkeys, puppet
from studio.panels.actions import ORDERS

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
README = (ROOT / "README.md").read_text()
PAGES = [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]
PICTURES = sorted((DOCS / "pictures").iterdir())
LARGEST_PICTURE = 2_000_000  # bytes


def blocks(language: str, *pages: Path) -> list[str]:
    texts = (page.read_text() for page in pages)
    return [b for text in texts for b in re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)]


@pytest.mark.parametrize("code", blocks("python", DOCS / "extending.md", DOCS / "field.md"))
def test_python_runs(code: str, capfd) -> None:
    exec(compile(code, "a page", "exec"), {})
    assert capfd.readouterr().out


COMMANDS = [
    line.partition("#")[0].strip() for block in blocks("sh", *PAGES) for line in block.splitlines()
]


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_are_understood(command: str, tmp_path: Path, monkeypatch, capfd) -> None:
    """Each is run on a sample; those that open the browser are asked for their help instead."""
    monkeypatch.chdir(tmp_path)  # where it may leave files
    name, *arguments = shlex.split(re.sub(r"[\[\]]", "", command))
    assert name == "studio"
    if "--headless" in arguments:
        arguments += ["--demonstrations", "1"]
    elif "FILE" in command:
        sample = str(ROOT / "recordings" / "samples" / "teaches-the-push.jsonl")
        arguments = [sample if argument.startswith("FILE") else argument for argument in arguments]
    else:
        arguments.append("--help")
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    assert not ended.value.code, capfd.readouterr().err


def test_the_formats_example_is_the_format(tmp_path: Path) -> None:
    (example,) = blocks("json", DOCS / "files.md")
    frame = json.loads(example)
    for key, whole in (("positions", [0.1, 0.2, 2.0]), ("tracking", 2)):
        assert frame[key][0] == whole
        frame[key] = [whole] * 25
    empty = re.search(r"`(\{\"skeleton\": 1, \"time\": 0.5\})`", (DOCS / "files.md").read_text())
    assert empty is not None
    (tmp_path / "example").write_text(f"{json.dumps(frame)}\n{empty[1]}\n")
    read = read_skeletons(tmp_path / "example")
    assert (len(read), read.frames) == (1, 2)


def test_the_two_commands_are_one_line_each() -> None:
    for end in ("studio", "pytest"):
        (line,) = re.findall(rf"^    (python3 -m venv .*/{end})$", README, re.MULTILINE)
        assert line.count("&&") == 2


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_to_a_file_leads_to_one(page: Path) -> None:
    for link in re.findall(r"\]\(([^)#:]+)\)", page.read_text()):
        assert (page.parent / link).exists(), link


def test_every_page_is_found_from_the_readme() -> None:
    for page in PAGES[1:]:
        assert f"](docs/{page.name})" in README, page.name


def test_its_tokens_are_long_enough() -> None:
    for page in PAGES:
        for token in re.findall(r"(?:TOKEN=|token=|--token |Bearer\s)([\w-]+)", page.read_text()):
            check_address(Address("0.0.0.0"), token)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_picture_that_is_shown_exists(page: Path) -> None:
    for picture in re.findall(r"!\[.*?\]\((.*?)\)", page.read_text()):
        assert (page.parent / picture).stat().st_size > 10_000, picture


@pytest.mark.parametrize("picture", PICTURES, ids=lambda picture: picture.name)
def test_every_picture_is_light_and_found_from_a_page(picture: Path) -> None:
    assert picture.stat().st_size < LARGEST_PICTURE
    assert any(f"pictures/{picture.name})" in page.read_text() for page in PAGES)


def test_every_picture_is_made_by_one_command() -> None:
    """Those of the page by the script itself, those of measurements by what it runs."""
    script = (DOCS / "make_pictures.py").read_text()
    drawn = [path for path in DOCS.iterdir() if path.suffix in (".svg", ".png", ".webp")]
    assert len(drawn) >= 4
    assert [path.name for path in drawn if path.name not in script] == []
    for bench in re.findall(r'"(tests/bench/\w+\.py)"', script):
        assert (ROOT / bench).exists()
    assert "`python docs/make_pictures.py`" in README
    assert "`--all`" in README


def test_the_readme_begins_with_something_that_moves() -> None:
    first = README.index("![")
    (name,) = re.findall(r"!\[.*?\]\((.*?)\)", README)[:1]
    assert first < 600
    assert (ROOT / name).read_bytes().count(b"ANMF") > 20  # the frames of an animated WebP


@pytest.mark.parametrize("guide", ["README.md", "docs/lecturers.md", "docs/students.md"])
def test_what_a_guide_has_in_bold_stands_on_the_page(guide: str) -> None:
    panels = "".join(path.read_text() for path in (ROOT / "studio" / "panels").glob("*.py"))
    steps = re.split("^## (?:Words|Where)", (ROOT / guide).read_text(), flags=re.MULTILINE)[0]
    bold = [" ".join(words.split()) for words in re.findall(r"\*\*(.+?)\*\*", steps, re.DOTALL)]
    labels = {label for words in bold for label in words.split(", ")}
    assert len(labels) > 5
    assert [label for label in sorted(labels) if label not in panels] == []


def test_every_key_that_is_named_does_something() -> None:
    """As ``key T``, ``Key N`` or ``keys L, O, C``, wherever the line ends."""
    bound = {each.key.shown for each in ORDERS if each.key is not None}
    bound |= {key.shown for key in hotkeys._PAGE_KEYS.values()} | set(puppet.KEYS.values())
    assert {"T", "N", "B", "Z"} & bound == {"T", "N", "B"}  # Z does nothing without Ctrl
    named = {
        (page.name, key)
        for page in PAGES
        for keys in re.findall(r"\b[Kk]eys?\s+((?:[A-Z]\b(?:,\s|\sand\s)?)+)", page.read_text())
        for key in re.findall("[A-Z]", keys)
    }
    assert {("README.md", "N"), ("README.md", "O"), ("lecturers.md", "B")} <= named
    assert [(page, key) for page, key in sorted(named) if key not in bound] == []
