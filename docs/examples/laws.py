"""What a law is worth: an hour of a mini traction machine, each time with another law. Keys are those of `--set`."""

from pathlib import Path

import matplotlib.pyplot as plt

from contact_core import Scene, advance, initial_state

exchanged = {
    "as shipped": "",
    "oil of a data sheet": "lubricant.set=minr",
    "Barus' viscosity": "lubricant.viscosity.model=barus",
    "Carreau's rheology": "lubricant.rheology.model=carreau lubricant.rheology.critical_stress=5MPa "
    "lubricant.rheology.exponent=0.5",
    "incompressible oil": "lubricant.density.model=none",
    "a layer of 5 nm of oil": "lubricant.supply.model=film lubricant.supply.thickness=5nm "
    "lubricant.cavitation=mass_conserving",
    "oil from 150 um on": "lubricant.supply.model=meniscus lubricant.supply.distance=150um",
    "bodies that warm": "heat.bulk.model=lumped heat.bulk.heat_capacity_1=1J/K heat.bulk.heat_capacity_2=1J/K "
    "heat.bulk.conductance_1=0.01W/K heat.bulk.conductance_2=0.01W/K",
    "tribofilm: Andersson": "tribofilm.set=andersson_90c tribofilm.beyond_fit=extrapolate",
    "tribofilm: Zhang and Spikes": "tribofilm.set=zhang_spikes_80c_ethylhexyl",
    "tribofilm: Gosvami": "tribofilm.set=gosvami",
    "tribofilm: combined": "tribofilm.set=combined_80c",
    "tribofilm: Arrhenius": "tribofilm.set=zddp_60_100c",
    "tribofilm wears first": "wear.model=film_first wear.thin=10nm",
    "oxide": "oxide.model=logarithmic",
    "damage: Dang Van": "stress.set=bearing_52100 fatigue.set=bearing_52100",
    "damage: Basquin": "stress.set=bearing_52100 fatigue.set=bearing_52100_basquin",
    "damage: Morrow": "stress.set=bearing_52100 fatigue.set=bearing_52100_morrow",
    "scuffing": "scuffing.set=mineral_oil",
}
ends = {}
for name, settings in exchanged.items():
    keys = dict(setting.split("=") for setting in settings.split())
    scene = Scene.from_toml("mtm_zddp", {"film.model": "regression"} | keys)
    state = initial_state(scene)
    for step in (1e-3, *60 * [60.0]):  # s
        state, ends[name] = advance(scene, scene.operation.point, state, step)
for name in ("damage: Dang Van", "damage: Basquin", "damage: Morrow"):
    known = 1.0 + ends[name].error_damage
    print(f"{name}: {ends[name].damage_2:.2g} of a life in an hour, known to a factor of {known:.2g}")
print(f"scuffing: {100.0 * ends['scuffing'].scuffing_ratio:.2g} % of the way to the critical temperature")

figure, axes = plt.subplots(1, 4, figsize=(10.5, 4.6), layout="constrained", sharey=True)
for axis, output, factor, label in zip(
    axes, ("friction_coefficient", "h_c", "tribofilm_2", "wear_depth_1"), (1.0, 1e9, 1e9, 1e9),
    ("friction coefficient", "central film [nm]", "tribofilm on the disc [nm]", "wear of the ball [nm]"), strict=True,
):  # fmt: skip
    axis.barh([*ends], [factor * getattr(end, output) for end in ends.values()])
    axis.set(xlabel=label)
axes[0].invert_yaxis()
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
