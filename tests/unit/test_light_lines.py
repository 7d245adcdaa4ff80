"""Light rough lines: Newton's method comes to rest where asperities hold and let go of nodes in turn."""

from dataclasses import replace

from contact_core import Scene, Transient, initial_state
from contact_core.deterministic.sampling import first_film
from contact_core.deterministic.transient import next_instant
from contact_core.scene import Case

LIGHT = {
    "operation.load": "40 N",
    "geometry.face_width": "8 mm",
    "film.points": "65",
    "film.domain": "0.4 mm",
    "film.width": "0.1 mm",
    **dict.fromkeys(("heat.model", "tribofilm.model", "wear.model"), "none"),
}


def test_instants_of_a_light_rough_line_converge():
    """Without half steps 7 of 12 stop at 30 Newton steps, the nodes still changing between solids and oil."""
    scene = Scene.from_toml("fzg_flank", LIGHT)
    case = Case.bind(scene, scene.operation.point)
    state = initial_state(scene)
    state = replace(state, film=first_film(case, state))
    dt = scene.film.spacing / case.fastest
    converged = 0
    for _ in range(12):
        state, fields = next_instant(case, state, [u * dt for u in case.speeds], Transient(dt, 0, 300, heated=False))
        converged += fields.converged
    assert converged >= 9
