"""Links from `doi:10...` in pages and docstrings."""

import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms.post_transforms import SphinxPostTransform

DOI = re.compile(r"doi:(10\.\d{4,}/[^\s,;`\"']*[\w)])")


class DoiLinks(SphinxPostTransform):
    """Puts links in the place of the DOIs in a page's text."""

    default_priority = 800

    def run(self, **kwargs: Any) -> None:
        """Change the page's tree."""
        for text in list(self.document.findall(nodes.Text)):
            if isinstance(text.parent, nodes.literal | nodes.literal_block | nodes.reference):
                continue
            found, end = [], 0
            for match in DOI.finditer(text):
                doi = balanced(match[1])
                start = match.start()
                found += [nodes.Text(text[end:start])]
                found += [nodes.reference("", f"doi:{doi}", refuri=f"https://doi.org/{doi}")]
                end = start + len(f"doi:{doi}")
            if found:
                text.parent.replace(text, [*found, nodes.Text(text[end:])])


def balanced(doi: str) -> str:
    """Return a DOI without a closing bracket that belongs to the text around it."""
    while doi.endswith(")") and doi.count(")") > doi.count("("):
        doi = doi[:-1]
    return doi


def setup(app: Sphinx) -> dict[str, bool]:
    """Add it to Sphinx."""
    app.add_post_transform(DoiLinks)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
