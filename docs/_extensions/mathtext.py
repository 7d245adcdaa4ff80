"""Sets the equations of pages by matplotlib, as SVG in the page: no network, no LaTeX."""

import re
from io import BytesIO

from docutils import nodes
from matplotlib.figure import Figure
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

_SIZE, _EM = 12, 10.5  # points of the font, and of the text around it


def svg(latex: str) -> str:
    """Return an equation as SVG, in the colour of the text around it."""
    file = BytesIO()
    figure = Figure(figsize=(0.01, 0.01))
    figure.text(0.0, 0.0, f"${latex}$", fontsize=_SIZE, color="black", math_fontfamily="stix")
    figure.savefig(file, format="svg", bbox_inches="tight", pad_inches=0.02, transparent=True, metadata={"Date": None})
    found = file.getvalue().decode()
    found = found[found.index("<svg") :]
    width, height = (float(re.search(rf'{name}="([\d.]+)pt"', found)[1]) for name in ("width", "height"))
    found = re.sub(r'width="[\d.]+pt"', f'width="{width / _EM:.3f}em"', found, count=1)
    found = re.sub(r'height="[\d.]+pt"', f'height="{height / _EM:.3f}em"', found, count=1)
    found = re.sub(r"<metadata>.*?</metadata>", "", found, flags=re.DOTALL)
    return found.replace("<g id=", '<g fill="currentColor" id=', 1)


def _block(self: HTML5Translator, node: nodes.math_block) -> None:
    self.body.append(
        f'<div class="math" role="math" style="overflow-x: auto">{svg(" ".join(node.astext().split()))}</div>'
    )
    raise nodes.SkipNode


def _inline(self: HTML5Translator, node: nodes.math) -> None:
    self.body.append(svg(node.astext()))
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Offer it as `html_math_renderer`."""
    app.add_html_math_renderer("mathtext", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
