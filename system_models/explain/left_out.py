"""What a scene leaves out: laws and options that are off, and what each costs in trust."""

from collections.abc import Iterator
from dataclasses import fields
from typing import Any

from contact_core.scene import Scene
from contact_core.scene.in_use import in_use
from contact_core.scene.toml import flat
from fmu_src.package.document.contact import not_modelled

from .model import Absent

_MEANS = (
    "Fields: one mean film and one mean contact stand for all nodes, by curves fitted to the deterministic level. "
    "h_min and pressure_max are not known, and no map of pressure, gap, tribofilm or wear."
)
# by key and choice, None: not given; laws say it themselves, in their equations
OPTIONS: dict[str, dict[str | None, str]] = {
    "film.model": {"regression": _MEANS},
    "lubricant.flow": {
        "newtonian": "Thinning of the flow: Reynolds' equation sees the viscosity at the temperature of the inlet. Of "
        "oils that thin under shear, and of warm films, the film comes out too thick; 'local' counts both."
    },
    "heat.inlet_shear": {
        "none": "Heat of shear in the inlet: fast films come out too thick, of an oil of 10 mPa s by 5 % at 5 m/s and "
        "by 11 % at 10 m/s, more if they slide; 'gupta' counts it."
    },
    "control.inputs": {
        "quasi_steady": "The time that a film needs to follow a change of load, speeds or radii; 'transient' follows."
    },
    "plasticity.indentation": {
        "none": "Hardening of tribofilms that have been pressed in: all films count as healed before every pass."
    },
    "stress.pits": {"counted": "The shape of micropits: they are counted, and the surface stays as it is."},
    "solids.film_modulus": {None: "Elasticity of the tribofilm: it is as rigid as its solid."},
    "surface_1.microroughness": {
        None: "Roughness of body 1 below the grid: what is shorter than two nodes carries nothing."
    },
    "surface_2.microroughness": {
        None: "Roughness of body 2 below the grid: what is shorter than two nodes carries nothing."
    },
}


def of(scene: Scene) -> list[Absent]:
    """Return what a scene leaves out: by its laws and options, table by table, and what every scene leaves out."""
    tables = [f.name for f in fields(scene)]
    ours = sorted(_of_choices(scene), key=lambda absent: tables.index(absent.key.partition(".")[0]))
    return [*ours, *(Absent("", "", f"{said[0].upper()}{said[1:]}.") for said in not_modelled(scene))]


def _of_choices(scene: Scene) -> Iterator[Absent]:
    for law in in_use(scene):
        if law.equations.left_out:
            yield Absent(f"{law.path}.model", law.law.name, law.equations.left_out)
    for shown in scene.film.governing(scene.geometry, scene.lubricant):
        if shown.left_out:
            key, _, choice = shown.title.rpartition(": ")[2].partition(" = ")
            yield Absent(key, choice, shown.left_out)
    table = flat(scene.to_dict())
    for option, costs in OPTIONS.items():
        chosen = table.get(option)
        if chosen in costs and (chosen is not None or not _given(scene, option)):
            yield Absent(option, chosen or "", costs[chosen])


def _given(scene: Scene, key: str) -> bool:
    record: Any = scene
    for name in key.split("."):
        record = getattr(record, name, None)
    return record is not None
