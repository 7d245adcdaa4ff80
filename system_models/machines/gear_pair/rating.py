"""What the standards of load capacity ask beside the machine: the table [rating] of a gear pair's file, optional."""

from dataclasses import dataclass

from contact_core.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class Rating:
    """Results of oil tests, and factors of oil, supply and steel.

    Stages are those at which the oil fails. The default of micropitting_stage is assumed, in the middle of the classes
    of FVA 54/7; that of scuffing_stage is the least that DIN 51524-2 asks of anti-wear oils (from memory).
    """

    micropitting_stage: int = parameter(
        "",
        "load stage at which the oil fails GF-C/8.3/90 of FVA 54/7; 11: passes stage 10",
        least=5,
        most=11,
        default=8,
    )
    scuffing_stage: int = parameter(
        "",
        "load stage at which the oil fails A/8.3/90 of ISO 14635-1; 13: passes stage 12",
        least=3,
        most=13,
        default=10,
    )
    oil_factor: float = parameter(
        "",
        "X_L of the oil's kind: 1 mineral, 0.8 polyalphaolefin, 0.6 to 0.7 polyglycol",
        least=0.4,
        most=2.0,
        default=1.0,
    )
    supply_factor: float = parameter(
        "", "X_S of the oil's way to the gears: 1.2 jet, 1 bath, 0.2 submerged", least=0.1, most=2.0, default=1.0
    )
    material_factor: float = parameter(
        "", "W_W of the steel against micropitting: 1 case-hardened", least=0.1, most=3.0, default=1.0
    )
    structural_factor: float = parameter(
        "", "X_W of the steel against scuffing: 1 case-hardened, 1.5 nitrided", least=0.1, most=3.0, default=1.0
    )
