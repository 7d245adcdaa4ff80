"""The page: sections in order, style."""

from html import escape

from contact_core.scene import Scene

from ...flavours import Flavour, Version
from ...runtime.resources import MODEL
from . import contact, formulas, interface

_STYLE = """
body { max-width: 60em; margin: 2em auto; padding: 0 1em; font: 16px/1.5 system-ui, sans-serif; color: #222; }
h1, h2, h3 { line-height: 1.2; } h2 { margin-top: 2.2em; border-bottom: 1px solid #bbb; } h3 { margin: 1.4em 0 .3em; }
table { border-collapse: collapse; margin: .8em 0; font-size: .88em; }
th, td { border-bottom: 1px solid #ddd; padding: .25em .7em .25em 0; text-align: left; vertical-align: top; }
code { font-size: .95em; } .wide { overflow-x: auto; } .source { font-size: .85em; color: #555; margin: .2em 0; }
.equation { font-family: Cambria, "Times New Roman", serif; font-size: 1.12em; margin: .3em 0 .3em 1.5em;
  white-space: pre-wrap; }
svg { max-width: 34em; display: block; font-size: 14px; } svg text { fill: #222; }
.middle { text-anchor: middle; } .end { text-anchor: end; }
.line path, .input, .asked, .output { fill: none; stroke: #222; stroke-width: 1.6; } .line .grid { stroke: #ccc; }
.ball { fill: #c3cbd4; } .disc { fill: #9aa5b1; } .oil { fill: #f3b34a; } .line .force { stroke: #a33; }
svg text.force { fill: #a33; } .input { stroke: #1f5fa8; stroke-width: 2.4; } .output { stroke: #a33; }
.asked { stroke-dasharray: 4 4; stroke: #888; } nav a { margin-right: 1em; white-space: nowrap; }
@media print { body { max-width: none; } h2, h3 { break-after: avoid; } }
"""

_PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>{title}</title><style>{style}</style></head>
<body>
<h1>{title}</h1>
<p>{description}</p>
<nav>{contents}</nav>
{body}
</body>
</html>
"""


def documentation(scene: Scene, flavour: Flavour, reference: bool, fmi: Version = 2) -> bytes:
    """Return the page of a scene's FMU, UTF-8; `reference`: the FMU carries reference data."""
    sections = {
        "contact": ("The contact", contact.data(scene, flavour)),
        "signs": ("Signs and directions", contact.signs(scene)),
        "equations": ("Equations", formulas.equations(scene)),
        "validity": ("Range of validity", contact.validity(scene)),
        "errors": ("Errors of the outputs", contact.errors(scene)),
        "assumed": ("What is assumed, and what it is worth", contact.assumptions(scene)),
        "steps": ("Steps", contact.steps(scene)),
        "status": ("Status, <code>valid</code> and <code>range_flags</code>", interface.status(flavour, fmi)),
        "variables": ("Variables", interface.variable_tables(scene, flavour)),
        "state": ("State", interface.state(flavour, fmi)),
        "log": ("Log", interface.log(flavour, fmi)),
        "needs": ("Requirements", interface.requirements(flavour)),
        "check": ("Check", interface.check(reference)),
        "licence": ("Licence", interface.licence(flavour, fmi)),
    }
    body = [part for name, (title, parts) in sections.items() for part in (f'<h2 id="{name}">{title}</h2>', *parts)]
    page = _PAGE.format(
        title=escape(f"{MODEL}: {scene.name}"),
        description=escape(scene.description),
        style=_STYLE,
        contents=" ".join(f'<a href="#{name}">{title}</a>' for name, (title, _) in sections.items()),
        body="\n".join(body),
    )
    return page.encode()
