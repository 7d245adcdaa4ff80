"""The equations of every law and film, in the notation of `markup.equation`, for the FMU's documentation."""

Lines = tuple[str, ...]

# What every contact of a level solves: title, lines, a sentence.
GOVERNING: dict[str, tuple[tuple[str, Lines, str], ...]] = {
    "deterministic": (
        (
            "Flow of the oil (Reynolds)",
            (
                "∂/∂x [ρ h^3/(12 η) ∂p_f/∂x] + ∂/∂y [ρ h^3/(12 η) ∂p_f/∂y] = u_e ∂(ρ h)/∂x + ∂(ρ h)/∂t",
                "p_f ≥ 0,   u_e = (u_1 + u_2)/2",
            ),
            "At every node, with the squeeze of the passing roughness.",
        ),
        (
            "Gap",
            ("h = h_0 + g(x, y) − z_1 − z_2 + d",),
            "g is the gap of the undeformed bodies (geometry), z are the heights of both surfaces as they are now, "
            "tribofilm, wear and plastic depth included.",
        ),
    ),
    "regression": (),
}

# The part of it that is a matter of the shape.
_HALF_SPACE = (
    "Elastic deformation (half space)",
    ("d(x, y) = 2/(π E′) ∬ p(x′, y′) [(x − x′)^2 + (y − y′)^2]^{−1/2} dx′ dy′",),
    "p is the pressure of oil and solids together.",
)
_LOAD = ("Load balance", ("W = ∬ p dx dy",), "It decides the rigid gap h0.")
_ROLLING = "Rolling resistance"
_ROLLING_TEXT = (
    "Of smooth bodies under a flooded inlet, U = 2 η0 u_e/(E′ Rx) (Biboulet and Houpert 2010); (1 − Wc) of it is left "
    "where solids carry load, and as much less as inlet heating, thinning or starvation leave less film."
)
_ROLLING_LINE = (
    _ROLLING,
    (
        "F_r = b E′ R_x 1.42 (U w)^{1/2} [1 + (0.966 M^{1/2})^{10}]^{−1/10} (1 − W_c)",
        "w = W/(b E′ R_x),   M = w U^{−1/2}",
    ),
    _ROLLING_TEXT + " b is the face width.",
)
_ROLLING_POINT = (
    _ROLLING,
    (
        "F_r = 2 b E′ R_x U^{3/4} [(r − e)/(1 + M/6.6) + e] (1 − W_c)",
        "r = 0.77 β^{−1/3} k^{0.12} U^{−1/12},   e = 1.8 β^{−1/4}",
        "M = β^{1/4} k W/(E′ R_x^2) U^{−3/4},   β = E′ a/(π p_H R_x),   k = a/b",
    ),
    _ROLLING_TEXT + " a and b are Hertz's half widths.",
)
_SMOOTH_LINE = (
    "Film of the smooth bodies",
    ("h_s = R_x U^{1/2} H(M, L),   λ = h_s/σ",),
    "H is Moes' formula of line contacts over all regimes, σ the composite rms roughness now; thinned in the inlet "
    "where heat.inlet_shear or lubricant.flow ask for it, and starved as lubricant.supply says.",
)
OF_SHAPE: dict[tuple[str, str], tuple[tuple[str, Lines, str], ...]] = {
    ("deterministic", "point"): (_HALF_SPACE, _LOAD),
    ("deterministic", "roller"): (_HALF_SPACE, _LOAD),
    ("deterministic", "line"): (
        (
            "Elastic deformation (half space)",
            (
                "d(x, y) = 2/(π E′) Σ_{k} ∬ p(x′, y′) {[(x − x′)^2 + (y − y′ − k w)^2]^{−1/2} − d_k} dx′ dy′",
                "d̄(x) = −4/(π E′) ∫ p̄(x′) ln(|x − x′|/b) dx′",
            ),
            "p is the pressure of oil and solids together, which repeats itself along y with the period w. A line has "
            "no approach of its own: the datum dk is such that the means over a period deform as the second line "
            "says, counted from a face width b away.",
        ),
        ("Load balance", ("W = (b/w) ∬ p dx dy",), "Over one period. It decides the rigid gap h0."),
    ),
    ("regression", "point"): (
        (
            "Film of the smooth bodies",
            ("h_s = R_x U^{1/2} H(M, L, R_x/R_y),   λ = h_s/σ",),
            "H is the formula of Nijenbanning, Venner and Moes over all regimes, σ the composite rms roughness now; "
            "thinned in the inlet where heat.inlet_shear or lubricant.flow ask for it, and starved as lubricant.supply "
            "says.",
        ),
        _ROLLING_POINT,
    ),
    ("regression", "line"): (_SMOOTH_LINE, _ROLLING_LINE),
    ("regression", "roller"): (_SMOOTH_LINE, _ROLLING_LINE),
}

# What becomes of oil that would be under tension, by lubricant.cavitation at the deterministic level.
CAVITATION: dict[str, tuple[Lines, str]] = {
    "reynolds": (
        ("p_f = 0 where it would be negative",),
        "The gap counts as full there, so that oil comes from nowhere behind a cavity (Reynolds' outlet).",
    ),
    "mass_conserving": (
        ("p_f ≥ 0,   0 ≤ θ ≤ 1,   p_f (1 − θ) = 0", "ρ h → θ ρ h in entrainment and squeeze"),
        "θ is how much of the gap oil fills. What flows into a cavity flows out of it (Jakobsson, Floberg, Olsson; "
        "Elrod).",
    ),
}

# How solids and oil share the load, by film.criterion at the deterministic level.
SHARING: dict[str, tuple[Lines, str]] = {
    "split": (
        (
            "h > h_{floor}:   p = p_f",
            "h = h_{floor}:   p = p_f + p_s,   p_s ≥ 0",
            "0 ≤ p ≤ hardness,   W_c = ∬ p_s dx dy / W",
        ),
        "Solids touch where the gap is down to film.floor, the thickness of the adsorbed layer; what would overlap "
        "beyond the hardness stays as plastic depth.",
    ),
    "lumped": (
        (
            "h > h_{floor}:   p is the oil's",
            "h = h_{floor}:   p is the solids'",
            "0 ≤ p ≤ hardness",
        ),
        "One pressure for both: where the gap is down to film.floor, all of it counts as the solids'.",
    ),
}

FRICTION: dict[str, tuple[Lines, str]] = {
    "deterministic": (
        (
            "F = −∬ (τ_{oil} + τ_{solid}) v_x/|v| dx dy,   v = (u_1 − u_2 − ω y, ω x)",
            "τ_N = η(p_f, T) |v|/h",
        ),
        "Summed node by node; the rheology makes the oil's stress of the Newtonian one, τN.",
    ),
    "regression": (
        (
            "F = −(μ W_c W + ⟨τ_{oil}⟩ A_{oil}) (u_1 − u_2)/|u_1 − u_2|",
            "τ_N = η(p, T) |u_1 − u_2|/h_c",
            "A_{oil} = (1 − W_c) A_H/k,   p = k p_H",
            "k = [1 + K z exp(−d λ z^q)] [(1 + S h_s R_x/a^2) (1 + S h_s R_y/b^2)]^{−1/2},   z = 0.2/s",
        ),
        "⟨τ⟩ is the oil's mean stress under k times Hertz's pressure, on the part of Hertz's area A H that makes up "
        "for it: between rough bodies oil carries load in spots, a thick film carries it on a larger area, of lines "
        "along x only. No pressure is above the hardness.",
    ),
}

_SHARING: tuple[Lines, str] = (
    (
        "1 − W_c = [1 − exp(−B Λ^C)] [1 − exp(−b (h_s/h_{floor})^c)],   Λ = λ (s/0.2)^m (r/2)",
        "A_c = [1 − exp(−c s)] W_c^D",
        "h_c/σ = W_c g + (1 − W_c) [(E λ/ρ)^n + f^n]^{1/n}",
        "g = (G/k) ln[1 + k (s/0.2)^{−1.5}],   f = F (s r/0.4)^{−0.75} ≥ g",
    ),
    "λ: film of the smooth bodies over composite roughness; s: mean Hertz pressure over what would press the "
    "roughness flat; r: correlation length over the distance of the nodes; ρ: density of the oil under Hertz's mean "
    "pressure.",
)

# (slot, law): lines and a sentence. Sources are the laws' own.
LAWS: dict[tuple[str, str], tuple[Lines, str]] = {
    ("viscosity", "roelands"): (
        (
            "η = η_0 exp{(ln η_0 + 9.67) [(1 + p/p_0)^z ((T − 138)/(T_0 − 138))^{−S} − 1]}",
            "p_0 = 196 MPa,   η in pascal seconds,   T in kelvin",
        ),
        "z and S follow from the pressure and temperature coefficients at p = 0 and T0.",
    ),
    ("viscosity", "barus"): (("η = η_0 exp[α p − β (T − T_0)]",), ""),
    ("viscosity", "modulus"): (
        ("η = K exp[C/(D + T)] exp{p/[a_1 + a_2 T + (b_1 + b_2 T) p]}",),
        "Vogel's law without pressure, the modulus equation with it.",
    ),
    ("viscosity", "astm_d341"): (
        (
            "log_{10} log_{10}(ν + 0.7) = A − B log_{10} T,   ν in mm^2/s",
            "η = η_∞ [η(0, T)/η_∞]^m,   m = (1 + p/p_0)^z",
        ),
        "A straight line through the data sheet's two viscosities; the density falls linearly with temperature. "
        "Under pressure Roelands' law, 63.1 µPa s and 196 MPa.",
    ),
    ("density", "dowson_higginson"): (("ρ/ρ_0 = (5.9 · 10^8 + 1.34 p)/(5.9 · 10^8 + p),   p in Pa",), ""),
    ("density", "none"): (("ρ = ρ_0",), "Incompressible."),
    ("rheology", "newtonian"): (("τ_{oil} = τ_N,   at most Λ p_f",), "Λ: limiting_coefficient; 0 means no limit."),
    ("rheology", "eyring"): (
        ("τ_{oil} = τ_E arsinh(τ_N/τ_E),   at most Λ p_f",),
        "Λ: limiting_coefficient; 0 means no limit.",
    ),
    ("rheology", "carreau"): (
        ("τ_{oil} = τ_N [1 + (τ_N/G)^2]^{(n − 1)/2},   at most Λ p_f",),
        "Λ: limiting_coefficient; 0 means no limit.",
    ),
    ("geometry", "point"): (("g = x^2/(2 R_x) + y^2/(2 R_y)",), "A circular or elliptical contact."),
    ("geometry", "line"): (
        ("g = x^2/(2 R_x)",),
        "A line without ends. One period across is solved and stands for all of face_width, over which load and "
        "outputs are meant.",
    ),
    ("geometry", "roller"): (
        ("g = x^2/(2 R_x) + P(y)",),
        "A line with ends, taken back by the profile P; load and outputs are those of the whole face_width b.",
    ),
    ("profile", "rounded"): (
        ("P = R_e − [R_e^2 − max(|y| − s/2, 0)^2]^{1/2},   |y| ≤ b/2",),
        "s is the straight length, Re the radius along the axis beyond it.",
    ),
    ("profile", "logarithmic"): (
        ("P = d ln{1/[1 − (2 y/b)^2]},   |y| < b/2",),
        "d is depth.",
    ),
    ("supply", "flooded"): (("p_f = 0 at the edge of the grid",), "The inlet is as full as the grid is wide."),
    ("supply", "film"): (
        ("ρ h θ = ρ_0 h_{oil} where oil comes in",),
        "h oil: thickness. Pressure begins where the gap has become full.",
    ),
    ("supply", "meniscus"): (("p_f = 0 for x < −d",), "d: distance. The gap is full from there on."),
    ("plasticity", "elastic_perfectly_plastic"): (
        ("p ≤ H(c),   H(c) = H_{steel} − (H_{steel} − H_{film}) c",),
        "c is how much of its full thickness the tribofilm that is met has; plastic depth is shared in halves.",
    ),
    ("boundary_friction", "film_blend"): (
        ("τ_{solid} = μ p_s tanh(|v|/v_0),   μ = μ_{bare} + (μ_{film} − μ_{bare}) c",),
        "c is the mean cover of both bodies by tribofilm, 0 to 1; v0 is slip_speed.",
    ),
    ("heat", "none"): (("T = T_{bulk},   Q_1 = Q_2 = P/2",), "Surfaces as warm as their bodies."),
    ("heat", "flash"): (
        (
            "ΔT = 1.22 r q/{√π [K_1 (0.6575 + Pe_1)^{1/2} + K_2 (0.6575 + Pe_2)^{1/2}]}",
            "q = τ |u_1 − u_2|,   Pe_i = |u_1 − u_2| r/(2 κ_i)",
        ),
        "The mean rise of a contact spot of radius r; K and κ are conductivity and diffusivity of the bodies.",
    ),
    ("heat", "field"): (
        (
            "T_i = T_{bulk,i} + G_i ∗ q_i,   q_1 + q_2 = q = τ |v|",
            "q_1 = q/2 + (k/h) (T_2 − T_1)",
        ),
        "G is the steady rise under a source that moves at the body's own speed, ∗ the sum over all nodes; the film "
        "conducts across its thickness.",
    ),
    ("bulk", "oil"): (("T_{bulk,1} = T_{bulk,2} = T_{oil}",), ""),
    ("bulk", "inputs"): (
        ("T_{bulk,i} = T_{b,i}",),
        "The inputs body_temperature_1 and _2; the heat flows are outputs.",
    ),
    ("bulk", "lumped"): (
        ("C_i ∂T_{bulk,i}/∂t = Q_i − G_i (T_{bulk,i} − T_{oil})",),
        "Exact over a step of constant heat.",
    ),
    ("tribofilm", "none"): (("h_t = 0",), "No additive."),
    ("tribofilm", "ghanbarzadeh"): (
        ("h_t = h_{max} [1 − exp(−k t)] − C_3 [1 − exp(−C_4 t)],   k = x k_B T/h_P",),
        "t is how long the point has been rubbed; kB and hP are Boltzmann's and Planck's constants.",
    ),
    ("tribofilm", "andersson"): (
        ("∂h_t/∂t = C_5 (1 − h_t/h_{max}) max(τ |u_1 − u_2| − C_6, 0)",),
        "Where solids touch; nothing is removed.",
    ),
    ("tribofilm", "zhang_spikes"): (
        (
            "∂h_t/∂t = A exp[−(E_0 − τ ΔV)/(k_B T)] (1 − h_t/h_{max}) − r h_t",
            "r = k_r p_s |v|",
        ),
        "τ is the shear stress of oil and solids: a full film grows a tribofilm, too.",
    ),
    ("tribofilm", "gosvami"): (
        (
            "∂h_t/∂t = A exp[−(E_0 − p_s ΔV)/(k_B T)] (1 − h_t/h_{max}) − r h_t",
            "r = k_r p_s |v|",
        ),
        "By the normal stress where solids touch.",
    ),
    ("tribofilm", "combined"): (
        (
            "∂h_t/∂t = (w_1 k c + w_2 g) (h_{max} − h_t) − r h_t",
            "k = x k_B T/h_P,   g = (A/h_{max}) exp[−(E_0 − τ ΔV)/(k_B T)],   r = k_r p_s |v|",
        ),
        "c is 1 where solids rub, else 0.",
    ),
    ("wear", "none"): (("w = 0",), ""),
    ("wear", "archard"): (
        ("∂w/∂t = K p_s v/H,   K = K_{bare} + (K_{film} − K_{bare}) c",),
        "ps is the mean pressure that a point of the surface feels from the other solid over its track, c how much of "
        "its full thickness its tribofilm has; wear.sliding says which speed v is.",
    ),
    ("sharing", "fitted"): _SHARING,
    ("sharing", "fitted_lines"): _SHARING,
}

# By tribofilm.dose: how the instants of a pass become growth over test time.
DOSES: dict[str, str] = {
    "clock": "Dose 'clock': a point that is rubbed at any instant of a pass counts as rubbed for the whole time.",
    "contact_length": "Dose 'contact_length': growth by the mean over the crossing of the contact's length.",
    "residence": "Dose 'residence': growth by the mean over the whole track.",
}

# What thins the film of an oil that shears: lines, a sentence, a source.
INLET_SHEAR: dict[str, tuple[Lines, str, str]] = {
    "gupta": (
        (
            "φ = [1 − 13.2 (p_H/E′) Q^{0.42}]/[1 + 0.213 (1 + 2.23 |S|^{0.83}) Q^{0.64}]",
            "Q = η_0 β u_e^2/k,   S = (u_1 − u_2)/u_e",
        ),
        "Shear warms the oil in the inlet: the film is φ of the isothermal one; β is −d ln η/dT there, k the oil's "
        "conductivity.",
        "Gupta, Cheng, Zhu, Forster & Schrand 1992, doi:10.1080/10402009208982117",
    ),
}
SHEAR_THINNING: tuple[Lines, str, str] = (
    (
        "φ = [1 + 0.79 X^m]^{−q},   X = (1 + |S|) u_e η_0/(h_s G)",
        "m = 1/(1 + 0.2 |S|),   q = 3.6 (1 − n)^{1.7},   S = (u_1 − u_2)/u_e",
    ),
    "Shear thins the oil in the inlet: the film is φ of the Newtonian one.",
    "Bair, Proc. IMechE J 219 (2005) 69",
)
