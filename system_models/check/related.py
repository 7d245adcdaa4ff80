"""The files that an FMU names as related to it in the manifest of the layered standard for references, fmi-ls-ref."""

import posixpath
from urllib.parse import unquote, urlsplit

from lxml import etree

MANIFEST = "extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml"


def related(manifest: etree._Element) -> dict[str, str]:
    """Return the first part of the role of each file in the FMU, such as `result`, by its path from the FMU's top."""
    roles = {}
    for element in manifest.iter("Related"):
        if path := located(MANIFEST, element.get("source", "")):
            roles[path] = element.get("role", "").partition("/")[0]
    return roles


def located(document: str, source: str) -> str:
    """Return the path of a file that a document of the FMU names by a URI; an empty text if it is none in the FMU."""
    uri = urlsplit(source)
    path = posixpath.normpath(posixpath.join(posixpath.dirname(document), unquote(uri.path)))
    outside = uri.scheme or uri.netloc or path.startswith(("/", ".."))
    return "" if outside or not uri.path else path
