"""Compile the kernels that most tests need: of films, of stress and damage, of the multigrid solver."""

from contact_core import Scene, advance, initial_state, point_contact, warm_up

SMALL = {"film.points": "17", "surface_1.correlation_length": "32 um", "surface_2.correlation_length": "32 um"}
STRESSED = {"stress.set": "bearing_52100", "stress.layers": "4", "fatigue.set": "bearing_52100"}

if __name__ == "__main__":
    warm_up(Scene.from_toml("mtm_zddp"))
    scene = Scene.from_toml("mtm_zddp", SMALL | STRESSED)
    advance(scene, scene.operation.point, initial_state(scene), 1.0)
    oil = {"viscosity": 0.01, "pressure_viscosity": 2e-8}
    point_contact(load=10.0, radius_x=0.01, reduced_modulus=2e11, speed_1=1.0, speed_2=1.0, **oil, grid=33)
