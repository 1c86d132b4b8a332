"""The site: built without a warning, every public name in it, nothing taken from the network, the examples run."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

ROOT = Path(__file__).parents[2]
ATTRIBUTES = {"src", "href"}


class References(HTMLParser):
    """What a page loads, and where it leads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.loaded: list[str] = []
        self.links: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Links of <a> lead away; everything else is loaded."""
        for name, value in attrs:
            if name in ATTRIBUTES and value is not None:
                (self.links if tag == "a" else self.loaded).append(value)


@pytest.fixture(scope="module")
def site() -> Path:
    """The site as ./dev docs builds it."""
    pytest.importorskip(
        "sphinx", reason="the site needs the extra sms[docs]; ./dev docs installs it"
    )
    pytest.importorskip("furo")
    if shutil.which("doxygen") is None:
        pytest.skip("the site needs doxygen; ./dev docs installs it")
    done = subprocess.run(
        [sys.executable, "-m", "tools.site"], cwd=ROOT, check=False, capture_output=True, text=True
    )  # fails on a warning, an example that fails, and a public name that is missing
    assert done.returncode == 0, done.stdout + done.stderr
    return ROOT / "build" / "docs" / "site"


@pytest.mark.full
def test_every_link_leads_somewhere_and_nothing_comes_from_the_network(site: Path) -> None:
    pages = sorted(site.rglob("*.html"))
    assert len(pages) > 100
    for page in pages:
        of = References(page.read_text(encoding="utf-8"))
        for loaded in of.loaded:
            assert not urlsplit(loaded).netloc or loaded.startswith("data:"), f"{page}: {loaded}"
        for link in (*of.links, *of.loaded):
            parts = urlsplit(link)
            if not parts.scheme and not parts.netloc and parts.path:
                target = page.parent / unquote(parts.path)
                assert target.exists(), f"{page.relative_to(site)}: {link}"
    styles = "".join(f.read_text() for f in site.rglob("*.css"))
    assert not re.search(r"url\(['\"]?https?:", styles)


@pytest.mark.full
def test_the_gallery_has_nine_examples_with_pictures_and_output(site: Path) -> None:
    pages = sorted(p for p in (site / "gallery").glob("*.html") if p.stem != "index")
    assert len(pages) == 9
    for page in pages:
        text = page.read_text(encoding="utf-8")
        assert f'src="../_images/{page.stem}.svg"' in text
        assert "It prints:" in text
    text = (site / "gallery" / "diagnosis.html").read_text(encoding="utf-8")
    assert "pressure-dependent seal friction" in text
