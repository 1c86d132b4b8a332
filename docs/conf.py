"""How Sphinx builds the site; `python -m tools.site` stages the pages and runs it, `./dev docs` runs that."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]  # of build/docs/source
sys.path.insert(0, str(ROOT))

from tools import release as made  # noqa: E402
from tools.site import extension  # noqa: E402

project = "sms"
author = "the sms authors"
copyright = "the sms authors, BSD-3-Clause"
release = version = made.version()
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]
html_theme = "furo"
html_title = f"sms {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {"navigation_with_keys": True}
templates_path: list[str] = []
exclude_patterns: list[str] = []
default_role = "literal"
nitpicky = False
add_module_names = False
toc_object_entries = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_type_aliases = {"Array": "Array", "ArrayLike": "ArrayLike"}
autodoc_preserve_defaults = True
python_use_unqualified_type_names = True
napoleon_numpy_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
myst_heading_anchors = 3
myst_enable_extensions = ["colon_fence"]
highlight_language = "text"
pygments_style = "friendly"
pygments_dark_style = "monokai"
maximum_signature_line_length = 88


def setup(app: Any) -> None:
    """Docstrings are plain prose; the front page of the gallery."""
    extension.setup(app)
