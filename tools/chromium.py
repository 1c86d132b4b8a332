"""A page photographed by a headless Chromium, for the pictures of the documentation."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
)


def chromium() -> str | None:
    """The browser; None where there is none."""
    return shutil.which("chromium") or shutil.which("chromium-browser")


def photograph(
    browser: str, address: str, picture: Path, size: tuple[int, int], profile: Path, until: str
) -> None:
    """Write a PNG of `size` pixels. profile: a folder for the browser's own files; until: its option that says when.

    CalledProcessError where the browser fails.
    """
    flags = (
        *FLAGS,
        f"--user-data-dir={profile}",
        f"--window-size={size[0]},{size[1]}",
        until,
        f"--screenshot={picture}",
    )
    subprocess.run([browser, *flags, address], check=True, capture_output=True)
