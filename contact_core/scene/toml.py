"""TOML to records, with a sentence for everything that does not fit, and back."""

import difflib
import pickle
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

from ..errors import SceneError, did_you_mean
from ..film import FILMS
from ..laws import SLOTS
from ..laws.base import Model
from ..laws.offered import laws_of
from ..shapes import GEOMETRIES
from . import ensemble, units
from .other_names import current, meant
from .problems import Missing, TableError
from .records import ACCURACY, CHOSEN
from .self_affine import SelfAffine
from .surface import Surface

_KINDS: dict[str, tuple[type[Model], ...]] = {
    "film": FILMS,
    "geometry": GEOMETRIES,
    "surface_1": (Surface, SelfAffine),
    "surface_2": (Surface, SelfAffine),
}
_USUAL = {"geometry", "surface_1", "surface_2"}  # without a `model`: the first kind
_UNNAMED = Surface  # its tables have never had a `model`, and stored states go by their text
DATA_SHEET = "viscosity_40 [m2/s], viscosity_100 [m2/s] and density [kg/m3] at 15 degC of the data sheet"
NO_UTF_8 = "it is not in UTF-8. Save it as UTF-8."  # in place of Python's words on a byte
_TOO = {"operation.duration": " `tribofmu run` takes it as --hours, too."}
_OF_FINISH = ("rq", "correlation_length", "correlation_length_across", "microroughness")
_SHARING = {film.name for film in FILMS if "sharing" in {f.name for f in fields(film)}}


def shipped_scenes() -> dict[str, str]:
    """Return names and descriptions of the scenes that come with the package."""
    folder = files("contact_core") / "data" / "scenes"
    tables = {p.name.removesuffix(".toml"): p for p in folder.iterdir() if p.name.endswith(".toml")}
    return {name: str(tomllib.loads(tables[name].read_text("utf-8"))["description"]) for name in sorted(tables)}


def read_table(source: str | Path, kind: str = "scene") -> dict[str, Any]:
    """Read a scene's TOML by name or path, as nested tables; `kind` of file, for messages."""
    try:
        table: dict[str, Any] = pickle.loads(_parsed(text_of(source, kind)))
        return table
    except tomllib.TOMLDecodeError as error:
        hint = _of_toml(Path(source), error)
        raise SceneError(f"The {kind} file '{source}' is not valid TOML: {error}.{hint}") from None


@lru_cache(maxsize=32)
def _parsed(text: str) -> bytes:
    """Return the tables of a text, from which each caller makes its own: sets are read for every scene anew."""
    return pickle.dumps(tomllib.loads(text))


def text_of(source: str | Path, kind: str = "scene") -> str:
    """Return the text of a scene's TOML by name or path; `kind` of file, for messages."""
    shipped = files("contact_core") / "data" / "scenes" / f"{source}.toml"
    path = Path(source)
    try:
        if path.suffix == ".toml":
            return path.read_text("utf-8-sig")  # editors of Windows put a mark before the text
        if shipped.is_file():
            return shipped.read_text("utf-8")
    except OSError as error:
        raise SceneError(f"The {kind} file '{source}' cannot be read: {error.strerror}.{file_like(path)}") from None
    except UnicodeDecodeError:
        raise SceneError(f"The {kind} file '{source}' is not valid TOML: {NO_UTF_8}") from None
    names = list(shipped_scenes())
    like = did_you_mean(str(source), names) or file_like(Path(f"{source}.toml"))
    raise SceneError(
        f"There is no scene '{source}'.{like} Shipped are {', '.join(names)}; or give the path of a .toml file."
    )


def given(source: str | Path, overrides: Mapping[str, str]) -> tuple[dict[str, Any], tuple[Path, ...]]:
    """Return a scene's tables with `overrides`, of dotted keys, and the folders in which its files are looked for."""
    folders = (folder_of(source), Path())
    table = located(ensemble.taken(read_table(source)), *folders)
    changes = {full_key(key, value): value for key, value in current(overrides).items()}
    for key, value in sorted(changes.items(), key=override_order):
        path, _, last = key.rpartition(".")
        if key in ensemble.FILES:
            table[path] = _with_file(table.get(path, {}), value, folders)
        else:
            override(table, key, located({last: value}, *reversed(folders))[last])
    if isinstance(table.get("intervals"), Mapping):
        table["intervals"] = still_assumed(flat(table["intervals"]), changes)
    return table, folders


def still_assumed(intervals: Mapping[str, Any], changes: Iterable[str]) -> dict[str, Any]:
    """Return the intervals of values that no change of a dotted key, or of its set, has replaced.

    Another model keeps the values that it has in common with the one before.
    """
    roots = [key.removesuffix(".set") for key in changes]

    def left(keys: str) -> bool:
        return not any(f"{key.strip()}.".startswith(f"{root}.") for key in keys.split(",") for root in roots)

    return {keys: ends for keys, ends in intervals.items() if left(keys)}


def _with_file(surface: Mapping[str, Any], file: str, folders: tuple[Path, ...]) -> dict[str, Any]:
    """Return the table of a surface with a file: in place of its list, else in place of all if it is a set.

    `folders` are those of `given`; files of the scene's own list are looked for in their order, others the other way.
    """
    rest = {key: value for key, value in surface.items() if key != "files"}
    replaced = "files" not in surface and ensemble.is_set(file)
    own = isinstance(surface.get("files"), list)
    return located(ensemble.with_file({} if replaced else rest, file), *(folders if own else reversed(folders)))


def _of_toml(path: Path, error: ValueError) -> str:
    """Return what the line of a TOML error should be, where that is known, or an empty text."""
    place = re.search(r"at line (\d+)", str(error))
    if not place:
        return ""
    line = path.read_text("utf-8").splitlines()[int(place[1]) - 1].strip()
    bare = re.sub(r"\"[^\"]*\"|'[^']*'", "", line.split("#")[0])
    key, _, value = (part.strip(" ;") for part in line.partition("="))
    if re.search(r"=\s*[+-]?[\d.,]*\d", bare) and '"' not in value:
        return f' Values with a unit stand in quotes, and decimals have a point: {key} = "{value.replace(",", ".")}".'
    if ";" in bare:
        return f" Leave out the ';' of '{line}': a line ends without one, and a list has commas."
    return f" The line is '{line}'."


def folder_of(source: str | Path) -> Path:
    """Return the folder of a scene's file, by name or path."""
    path = Path(source)
    return path.parent if path.suffix == ".toml" else Path(str(files("contact_core"))) / "data" / "scenes"


def file_like(path: Path) -> str:
    """Return " Did you mean ...?" if a file of this kind in the same folder is called much like it, else nothing."""
    found = {file.stem: str(file) for file in sorted(path.parent.glob(f"*{path.suffix}"))}
    close = difflib.get_close_matches(path.stem, list(found), n=1, cutoff=0.6)
    return f" Did you mean '{found[close[0]]}'?" if close else ""


def models_of(path: str) -> tuple[type[Model], ...]:
    """Return the records that a table at a dotted path may be, by its `model`; none if there is one kind only."""
    return _KINDS.get(path) or laws_of(path.rpartition(".")[2])


def override(table: dict[str, Any], key: str, value: str) -> None:
    """Set a dotted key.

    A new `model` keeps the keys it shares with the old one and drops the others; a new `set`, or list of sets, drops
    all other keys; `seed` drops the list `seeds`; `finish` drops the keys that it gives;
    `control.accuracy` drops those that it chooses, but for film.domain.
    """
    if key == ACCURACY:
        for part, field in (name.split(".") for name in CHOSEN if name != "film.domain"):
            table.get(part, {}).pop(field, None)
    *path, last = key.split(".")
    where = ".".join(path)
    for part in path:
        table = table.setdefault(part, {})
        if not isinstance(table, dict):
            raise SceneError(f"'{key}' cannot be set: '{part}' is a value, not a table.")
    if last == "model":
        full = with_named_set(dict(table), where)
        if full.get("model") == value:
            return
        table.clear()
        table |= _for_model(full, where, value)
    new_set = last == "set" and str(table.get("set")).lower() != value.lower()
    if new_set or (key in ensemble.LISTS and ensemble.is_set(value)):
        table.clear()
    if last == "seed":
        table.pop("seeds", None)
    if last == "finish" and table.get(last) != value:
        for each in _OF_FINISH:
            table.pop(each, None)
    table[last] = value


def flat(table: Mapping[str, Any], path: str = "") -> dict[str, Any]:
    """Return the values of nested tables by dotted key."""
    found: dict[str, Any] = {}
    for key, value in table.items():
        found |= flat(value, f"{path}{key}.") if isinstance(value, Mapping) else {f"{path}{key}": value}
    return found


def build(cls: type, table: Any, path: str) -> Any:
    """Return a record of `cls` from a table. Raises SceneError with all that is wrong or missing, by table and key."""
    if not isinstance(table, Mapping):
        raise SceneError(f"[{path}] must be a table.")
    table = with_named_set(dict(table), path)
    known, hints = {f.name: f for f in fields(cls)}, get_type_hints(cls)
    problems = TableError()
    asked: set[str] = set()  # keys that sentences on unknown ones ask for
    said = ""  # the last of these
    for key in table:
        if key not in known:
            where = f"[{path}]" if path else "The scene"
            keys = [*(["model"] if cls in models_of(path) else []), *known]
            hint = _elsewhere(cls, key, path) or _inside(hints, key, path)
            if other := meant(path, key):
                hint, asked = f" {other.sentence}", asked | {*other.keys}
                hint, said = ("" if hint == said else hint), hint
            elif not hint:
                hint = f"{did_you_mean(key, keys)} Known are {', '.join(keys)}."
            problems.wrong.append(f"{where} has no key '{key}'.{hint}")
    values = {}
    for name, f in known.items():
        full = f"{path}.{name}" if path else name
        if name in table:
            with problems.collected():
                values[name] = _value(hints[name], table[name], full, f)
        elif f.default is MISSING and name not in asked:
            problems.missing.append(_missing(full, f))
    problems.refuse()
    return cls(**values)


def _elsewhere(cls: type, key: str, path: str) -> str:
    """Return which other models of a table have a key that `cls` does not have, or an empty text."""
    models = models_of(path)
    own = [law.name for law in models if law is cls]
    others = [f"'{law.name}'" for law in models if key in {f.name for f in fields(law)}]
    return f" It belongs to model = {' or '.join(others)}, not to '{own[0]}'." if others else ""


def _inside(hints: Mapping[str, Any], key: str, path: str) -> str:
    """Return which tables inside a table have a key that itself does not have, or an empty text."""
    tables = []
    for name, hint in hints.items():
        full = f"{path}.{name}" if path else name
        records = models_of(full) or ((hint,) if is_dataclass(hint) else ())
        if any(key in {f.name for f in fields(record)} for record in records):
            tables.append(f"[{full}]")
    return f" It belongs to {' or '.join(tables)}." if tables else ""


def _value(hint: Any, raw: Any, full: str, f: "Field[Any]") -> Any:
    models = () if f.metadata else models_of(full)
    given = [kind for kind in get_args(hint) if kind is not NoneType]
    if len(given) == 1 and NoneType in get_args(hint):
        hint = given[0]
    if models:
        usual = models[0].name if full in _USUAL else getattr(f.default, "name", None)
        if isinstance(raw, Mapping) and not {"model", "set"} & set(raw) and usual:
            raw = {"model": usual, **raw}
        return _build_law(models, raw, full)
    if is_dataclass(hint):
        return build(hint, raw, full)  # type: ignore[arg-type]
    if get_origin(hint) is tuple:
        if not isinstance(raw, list):
            raise SceneError(f"[[{full}]] must be a list of tables.")
        return tuple(build(get_args(hint)[0], item, f"{full}[{i}]") for i, item in enumerate(raw))
    if hint is float:
        return units.parse(raw, f.metadata["unit"], full)
    if hint is int:
        number = units.parse(raw, "", full)
        if number != int(number):
            raise SceneError(f"{full} = {raw!r} must be a whole number.")
        return int(number)
    if not isinstance(raw, str):
        raise SceneError(f"{full} = {raw!r} must be text in quotes.")
    return raw


def _build_law(models: tuple[type[Model], ...], raw: Any, path: str) -> Any:
    if isinstance(raw, str):
        raw = {"model": raw}
    if not isinstance(raw, Mapping):
        raise SceneError(f"[{path}] must be a table with a 'model', or the model's name.")
    table, names = with_named_set(dict(raw), path), {m.name: m for m in models}
    model = table.pop("model", None)
    if model not in names:
        said = f"has no model '{model}'." + did_you_mean(str(model), list(names)) if model else "needs a 'model'."
        slot = path.rpartition(".")[2]
        offer = f" A package installed in this Python can offer it by an entry point tribofmu.laws.{slot}."
        offer = offer if slot in SLOTS else ""
        raise SceneError(f"[{path}] {said} Known are {', '.join(names)}. Its parameters are keys of [{path}].{offer}")
    return build(names[model], table, path)


_SET_FILES = {
    "lubricant": "lubricants",
    "solids": "solids",
    "heat": "solids",
    "plasticity": "solids",
    "tribofilm": "tribofilms",
    "stress": "fatigue",
    "fatigue": "fatigue",
    "scuffing": "scuffing",
    "surface_1": "surfaces",
    "surface_2": "surfaces",
}


_OF_FILE = ".toml:"  # in `set = "fitted.toml:NAME"`


def located(table: Mapping[str, Any], *folders: Path) -> dict[str, Any]:
    """Return the table with the paths of files of sets, `set = "fitted.toml:NAME"`, as found in one of the folders."""

    def found(key: str, value: Any) -> Any:
        if isinstance(value, Mapping):
            return located(value, *folders)
        if key != "set" or not isinstance(value, str):
            return value
        if value.endswith(".toml"):
            raise SceneError(f"set = '{value}' names a file alone. Write '{value}:NAME', NAME being one of its sets.")
        path, of_file, name = value.rpartition(_OF_FILE)
        return f"{_found(f'{path}.toml', folders)}:{name}" if of_file else value

    return {key: found(key, value) for key, value in table.items()}


def _found(file: str, folders: tuple[Path, ...]) -> Path:
    for folder in folders:
        if (folder / file).is_file():
            return (folder / file).resolve()
    places = ", ".join(f"'{folder.resolve()}'" for folder in dict.fromkeys(folders))
    raise SceneError(f"The file of sets '{file}' is not in {places}. Give its path from there, or an absolute one.")


def file_of_set(given: str, path: str) -> tuple[Path, str]:
    """Return the file of a set of the table at a dotted path, that table's usual one or `PATH.toml:name`, and its name.

    Raises SceneError for a table without named sets.
    """
    if _OF_FILE in given:
        file, _, name = given.rpartition(_OF_FILE)
        return Path(f"{file}.toml"), name.strip().lower()
    if path not in _SET_FILES:
        raise SceneError(
            f"[{path}] has no named sets. Known are sets for {', '.join(_SET_FILES)}; any table may have one of a "
            "file, such as set = 'fitted.toml:NAME'."
        )
    folder = Path(str(files("contact_core"))) / "data"
    return folder / f"{_SET_FILES[path]}.toml", given.strip().lower()


def with_named_set(table: dict[str, Any], path: str) -> dict[str, Any]:
    """Replace `set = "name"` (in capitals or not) by the named values of data/*.toml; keys written beside it win.

    `set = "PATH.toml:name"` takes them from the table [name.`path`] of that file.
    """
    if "set" not in table:
        return table
    chosen = str(table.pop("set"))
    file, name = file_of_set(chosen, path)
    data = {key.lower(): value for key, value in read_table(file, "set").items() if isinstance(value, dict)}
    sets = {key: value[path] for key, value in data.items() if isinstance(value.get(path), dict)}
    if name not in sets:
        where = f" in '{file}'" if _OF_FILE in chosen else ""
        known = f"Known are {', '.join(sets)}." if sets else f"There is no [NAME.{path}] in that file."
        raise SceneError(f"[{path}] has no set '{name}'{where}.{did_you_mean(name, list(sets))} {known}")
    return _merged(_beside(sets[name], file.parent), table, path)


def _beside(table: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return the table of a set with each `file = "heights.npy"` that lies beside the set's own file by its path."""

    def found(key: str, value: Any) -> Any:
        if isinstance(value, Mapping):
            return _beside(value, folder)
        there = key == "file" and isinstance(value, str) and (folder / value).is_file()
        return str(folder / value) if there else value

    return {key: found(key, value) for key, value in table.items()}


def _for_model(table: Mapping[str, Any], path: str, model: str) -> dict[str, Any]:
    """Return the keys of a law's table that the law `model` has, too."""
    shared = {f.name for law in models_of(path) if law.name == model for f in fields(law)}
    return {name: item for name, item in table.items() if name in shared}


def _merged(base: Mapping[str, Any], over: Mapping[str, Any], path: str) -> dict[str, Any]:
    """Return `base` with the keys of `over`, table by table; another `model` keeps the keys both have."""
    model = over.get("model", base.get("model"))
    merged = dict(base) if model == base.get("model") else _for_model(base, path, model)
    for key, value in over.items():
        both = isinstance(value, Mapping) and isinstance(merged.get(key), Mapping)
        merged[key] = _merged(merged[key], value, f"{path}.{key}") if both else value
    return merged


def _missing(full: str, f: "Field[Any]") -> Missing:
    """Return what to say of a field that a table does not give."""
    part, _, last = full.rpartition(".")
    models, sets = models_of(last), named_sets(part)
    instead = f", or {part}.set = one of {', '.join(sets)}" if sets else ""
    if full in ("surface_1.rq", "surface_2.rq"):
        instead = f", or {part}.finish, such as 'ground' or 'polished'{instead}"
    if "unit" in f.metadata:
        unit, text = f.metadata["unit"], f"{f.metadata['text']}{instead}"
        unit = f" [{unit}]" if unit else ""
        return Missing(full, f"{unit} ({text})".strip(), f"Give it{unit}: {text}.{_TOO.get(full, '')}")
    if models:
        sheet = f"{DATA_SHEET}, or " if full == "lubricant.viscosity" else ""
        text = f"{sheet}a 'model': {', '.join(law.name for law in models)}{instead}"
        return Missing(full, f"({text})", f"Add the table, with {text}.")
    if f.type in (str, "str"):
        return Missing(full, "(text in quotes)", "Give it as text in quotes.")
    return Missing(full, "(a table)", f"Add the table [{full}].")


def named_sets(path: str) -> list[str]:
    """Return the names of the sets that come with the package for a table."""
    if path not in _SET_FILES:
        return []
    return [key for key, value in _shipped_sets(path).items() if isinstance(value.get(path), dict)]


def _shipped_sets(path: str) -> dict[str, Any]:
    return tomllib.loads((files("contact_core") / "data" / f"{_SET_FILES[path]}.toml").read_text("utf-8"))


def unbuild(record: Any) -> dict[str, Any]:
    """Return nested tables of a record, with SI units, from which `build` makes an equal one."""
    named = type(record) in _all_models() and type(record) is not _UNNAMED
    table: dict[str, Any] = {"model": record.name} if named else {}
    for f in fields(record):
        value = getattr(record, f.name)
        if value is None or value == ():
            continue
        if is_dataclass(value):
            table[f.name] = unbuild(value)
        elif isinstance(value, tuple):
            table[f.name] = [unbuild(item) for item in value]
        elif isinstance(value, float) and f.metadata["unit"]:
            table[f.name] = f"{value!r} {f.metadata['unit']}"
        else:
            table[f.name] = value
    return table


def _all_models() -> set[type]:
    return {model for models in (*map(laws_of, SLOTS), *_KINDS.values()) for model in models}


def full_key(key: str, value: str) -> str:
    """Return the key that an override means: `heat.bulk=oil` is short for `heat.bulk.model=oil`."""
    return f"{key}.model" if value in {law.name for law in models_of(key)} else key


def override_order(item: tuple[str, str]) -> int:
    """Return the rank in which an override is applied: sets, models and accuracy first; they decide on other keys."""
    if item[0] in ensemble.LISTS:  # before the member that is picked of them
        return -1
    return {"set": 0, "model": 1, "accuracy": 2, "finish": 2}.get(
        item[0].rpartition(".")[2], 0 if item[0] in ensemble.FILES else 3
    )


def completed(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return a scene's table with the curves of load sharing that fit its geometry, if it names none and needs some."""
    film, geometry = table.get("film"), table.get("geometry")
    if not isinstance(film, Mapping) or not isinstance(geometry, Mapping):
        return dict(table)
    sharing = film.get("sharing", {})
    if film.get("model") not in _SHARING or not isinstance(sharing, Mapping) or "model" in sharing:
        return dict(table)
    bodies = {law.name: law for law in GEOMETRIES}
    usual = bodies.get(str(geometry.get("model")), GEOMETRIES[0]).sharing
    return {**table, "film": {**film, "sharing": {"model": usual.name, **sharing}}}
