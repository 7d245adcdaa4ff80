"""An FMU of your own, a block on a spring, coupled with a contact whose friction drags it along."""

from pathlib import Path

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

SUBSTEPS = 20


class Block(Fmi2Slave):
    """A mass [kg] on a spring [N/m] and a damper [N s/m], pulled by a force [N]."""

    def __init__(self, **kwargs):
        """Register parameters, input, outputs."""
        super().__init__(**kwargs)
        self.m, self.k, self.d = 0.5, 20e3, 20.0
        self.force = self.x = self.v = 0.0
        for name in ("m", "k", "d"):
            self.register_variable(Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed))
        self.register_variable(Real("force", causality=Fmi2Causality.input))
        for name in ("x", "v"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def do_step(self, time, size):
        """Move on, velocity first."""
        for _ in range(SUBSTEPS):
            self.v += size / SUBSTEPS * (self.force - self.k * self.x - self.d * self.v) / self.m
            self.x += size / SUBSTEPS * self.v
        return True


if __name__ == "__main__":
    import matplotlib.pyplot as plt
    from pythonfmu.builder import FmuBuilder

    from contact_core import Scene
    from fmu_src.package.build import build
    from system_models.master import System, simulate

    scene = Scene.from_toml("mtm_zddp", {"film.model": "regression"})
    fmus = {
        "block": FmuBuilder.build_FMU(__file__, ".", canGetAndSetFMUstate=True, canSerializeFMUstate=True),
        "contact": build(scene, Path("contact.fmu"), "embedded"),
    }
    rig = System(
        fmus=fmus,
        connections=[("block.v", "contact.speed_1"), ("contact.friction_force", "block.force")],
        parameters={"contact.speed_2": 0.1},
        schedule={"contact.load": [(0.0, 50.0), (0.5, 30.0)]},
    )
    run = simulate(rig, stop_time=1.0, step_size=5e-4, algorithm="gauss_seidel")
    spring, friction = 20e3 * float(run["block.x"][-1]), float(run["contact.friction_force"][-1])
    print(f"At the end the spring pulls with {spring:.3f} N, friction is {friction:.3f} N.")

    figure, (top, bottom) = plt.subplots(2, 1, figsize=(6.0, 4.4), layout="constrained", sharex=True)
    top.plot(run["time"], 1e6 * run["block.x"])
    bottom.plot(run["time"], run["contact.friction_force"])
    top.set_ylabel("place of the block [um]")
    bottom.set(xlabel="time [s]", ylabel="friction [N]")
    figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
