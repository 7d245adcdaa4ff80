"""The command `tribofmu docs`: lists the pages of the documentation, or shows one."""

import argparse
import pydoc

from contact_core.errors import ContactError, did_you_mean

from . import pages


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("page", metavar="PAGE", nargs="?", help="name of a page, such as scenes (default: list them)")


def run(arguments: argparse.Namespace) -> int:
    """Show a page, or the names and titles of all, through a pager on a terminal; return 0."""
    pydoc.pager(_page(arguments.page) if arguments.page else _listed())
    return 0


def _page(given: str) -> str:
    """Return the text of a page by its name, or by its path in the docs folder."""
    files = pages.files()
    name = pages.name_of(given.removeprefix("docs/").removesuffix(".md"))
    if name not in files:
        raise ContactError(f"There is no page '{given}'.{did_you_mean(name, list(files))} `tribofmu docs` lists them.")
    return files[name].read_text("utf-8")


def _listed() -> str:
    """Return names and titles, pages to read before those of measurements."""
    titles = {name: pages.title(file.read_text("utf-8")) for name, file in pages.files().items()}
    read = {name: title for name, title in titles.items() if not name.startswith(pages.MEASURED)}
    measured = {name: title for name, title in titles.items() if name not in read}
    tables = (
        "\n".join(f"  {name:{max(map(len, table))}}  {title}" for name, title in table.items())
        for table in (read, measured)
    )
    return "Show one by `tribofmu docs PAGE`.\n\n{}\n\nMeasured:\n\n{}\n".format(*tables)
