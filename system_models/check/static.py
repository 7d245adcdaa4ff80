"""Rules that need the file only: the table of all of them, and those on the archive and the files in it."""

import re
from collections import Counter
from pathlib import Path

import fmpy
from fmpy.validation import validate_fmu
from lxml import etree

from ..fmu.archive import DESCRIPTION
from ..fmu.errors import FmuError
from . import binaries, model_rules, unit_rules
from .model_rules import Rule
from .package import Package
from .related import MANIFEST, related
from .verdict import Answer, failed, noted, passed, some

_SCHEMATA = {
    "1": "fmi1/fmiModelDescription.xsd",
    "2": "fmi2/fmi2ModelDescription.xsd",
    "3": "fmi3/fmi3ModelDescription.xsd",
}
_OTHER_SCHEMATA = {  # FMUs of FMI 2.0 may have them, too
    "terminalsAndIcons/terminalsAndIcons.xml": "fmi3/fmi3TerminalsAndIcons.xsd",
    "sources/buildDescription.xml": "fmi3/fmi3BuildDescription.xsd",
}


def archive(package: Package) -> Answer:
    """Check that every file is whole, stays in the folder and is there once."""
    if wrong := package.archive.damage() or package.archive.unfit():
        return failed(wrong)
    different = Counter(name for name, _ in {(info.filename, info.CRC) for info in package.archive.infos})
    if twice := [name for name, count in different.items() if count > 1]:
        return failed(f"In the archive more than once, each time another: {some(twice)}.")
    if twice := [name for name, count in Counter(package.names).items() if count > 1]:
        return noted(f"In the archive more than once, each time the same: {some(twice)}.")
    return passed(f"{len(package.names)} files, all whole, all within the folder.")


def schema(package: Package) -> Answer:
    """Check the model description, terminals and build description against the XSDs of FMI."""
    file = _SCHEMATA.get(package.version[:1])
    if file is None:
        return failed(f"fmiVersion = '{package.version}' is none of 1.0, 2.0, 3.0.")
    documents = {DESCRIPTION: file} | {name: xsd for name, xsd in _OTHER_SCHEMATA.items() if name in package.names}
    for name, file in documents.items():
        if wrong := _invalid(package, name, file):
            return failed(wrong)
    return passed(f"Valid FMI {package.version}: {some([*documents])}.")


def _invalid(package: Package, name: str, schema_file: str) -> str:
    """Return the first error of a document in the archive; an empty text if it is valid."""
    xsd = etree.XMLSchema(file=str(Path(fmpy.__file__).parent / "schema" / schema_file))
    try:
        root = package.root if name == DESCRIPTION else package.archive.document(name)
    except FmuError as error:
        return str(error)
    if xsd.validate(root):
        return ""
    first = xsd.error_log[0]
    return f"Line {first.line} of {name}: {first.message}"


def validation(package: Package) -> Answer:
    """Check the FMU with the validation of fmpy."""
    problems = validate_fmu(str(package.path))
    if problems:
        return failed(f"{len(problems)} problem(s), the first: {' '.join(problems[0].split())}")
    return passed("fmpy.validation.validate_fmu finds no problem.")


def documentation(package: Package) -> Answer:
    """Check that there is a page for people."""
    page = "documentation/index.html"
    if page in package.names:
        return passed(f"{page}, {package.archive.size(page) / 1024:.0f} kB.")
    return noted(f"There is no {page}.")


def icon(package: Package) -> Answer:
    """Check that there is a picture for the host's canvas."""
    places = ("model.png", "terminalsAndIcons/icon.png", "terminalsAndIcons/icon.svg")
    found = [name for name in places if name in package.names]
    return passed(f"{found[0]}.") if found else noted("There is no icon (model.png).")


def licence(package: Package) -> Answer:
    """Check that a licence is stated."""
    files = [name for name in package.names if re.match(r"documentation/licenses/.+", name)]
    declared = package.root.get("license") or package.root.get("copyright")
    if files or declared:
        return passed(f"{' and '.join(filter(None, [some(files), declared]))}.")
    return noted("There is neither documentation/licenses/ nor an attribute license: nobody knows who may use it.")


def reference_data(package: Package) -> Answer:
    """Check that there are results with which an importer can check itself, and that named ones are there."""
    try:
        roles = related(package.archive.document(MANIFEST)) if MANIFEST in package.names else {}
    except FmuError as error:
        return failed(str(error))
    named = [name for name, role in roles.items() if role in ("experiment", "result")]
    if missing := sorted(set(named) - set(package.names)):
        return noted(f"{MANIFEST} names {some(missing)}, which the FMU does not hold.")
    found = named or [name for name in package.names if name.endswith("ref.csv")]
    if found:
        return passed(f"{some(found)}; --deep replays it.")
    return noted("There are no reference results (fmi-ls-ref or *ref.csv): an importer cannot check itself.")


RULES: dict[str, Rule] = {
    "archive": archive,
    "schema": schema,
    "fmpy": validation,
    "units": unit_rules.unit_of_reals,
    "unit audit": unit_rules.unit_audit,
    "nominals": model_rules.nominals,
    "starts": model_rules.starts,
    "aliases": model_rules.aliases,
    "outputs": model_rules.outputs,
    "dependencies": model_rules.dependencies,
    "initial unknowns": model_rules.initial_unknowns,
    "experiment": model_rules.experiment,
    "capabilities": model_rules.capabilities,
    "platforms": binaries.platforms,
    "functions": binaries.functions,
    "host needs": binaries.host_needs,
    "documentation": documentation,
    "icon": icon,
    "licence": licence,
    "reference data": reference_data,
}
