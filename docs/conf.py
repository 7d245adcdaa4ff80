"""The documentation as a site: `sphinx-build -W docs site`. It needs no network, and warnings are errors."""

import sys
from importlib.metadata import version as _version
from pathlib import Path

from pygments.lexers import TextLexer
from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).parent / "_extensions"))

project = "tribofmu"
author = copyright = "The tribofmu developers"
version = release = _version("tribofmu")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "sphinx_copybutton",
    "docstrings",
    "doi",
    "mathtext",
]
exclude_patterns = ["_extensions"]
default_role = "code"  # of docstrings: names in single backticks
myst_heading_anchors = 4
myst_fence_as_directive = ["math"]  # as GitHub has it
html_math_renderer = "mathtext"

autodoc_member_order = "bysource"
napoleon_use_ivar = True  # attributes are described in the docstrings of their classes alone
autodoc_typehints = "description"
autodoc_default_options = {"members": True, "undoc-members": False}

suppress_warnings = ["ref.python"]  # several laws have a parameter `friction`

html_theme = "furo"
html_title = f"tribofmu {version}"
html_show_sphinx = False
html_theme_options = {"navigation_with_keys": True}


def setup(app: Sphinx) -> None:
    """Show CSV as plain text."""
    app.add_lexer("csv", TextLexer)
