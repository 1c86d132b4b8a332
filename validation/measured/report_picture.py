"""The README's picture: the first screen of the report on the measured cylinder, as a browser shows it.

python -m validation.measured.report_picture        (needs Chromium: apt-get install chromium)
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from sms.data import cylinder_rig
from sms.diagnosis import diagnose
from sms.report.diagnosis import report_html

ROOT = Path(__file__).parents[2]
PICTURE = ROOT / "docs" / "report.png"
SIZE = (1200, 900)


def main() -> int:
    browser = shutil.which("chromium") or shutil.which("chromium-browser")
    if browser is None:
        print("report_picture: no Chromium here; apt-get install chromium", file=sys.stderr)
        return 2
    page = report_html(diagnose(cylinder_rig("cylinder_o_ring")))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "report.html"
        file.write_text(page, encoding="utf-8")
        flags = [
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--hide-scrollbars",
            f"--user-data-dir={folder}/profile",
            f"--window-size={SIZE[0]},{SIZE[1]}",
            "--virtual-time-budget=8000",
            f"--screenshot={PICTURE}",
        ]
        subprocess.run([browser, *flags, file.as_uri()], check=True, capture_output=True)
    print(PICTURE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
