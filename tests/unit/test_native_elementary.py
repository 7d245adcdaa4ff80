"""elementary.h against decimal numbers of 60 digits: errors in units in the last place, and what the edges give."""

import ctypes
import math
import random
import shutil
import subprocess
from decimal import Decimal, localcontext
from itertools import pairwise

import pytest

from fmu_src.native.build import FOLDER, WARNINGS
from fmu_src.native.tables import tables_h

pytestmark = [pytest.mark.unit, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

ONE = ("exp", "expm1", "log", "log1p", "log10", "tanh", "asinh")
TWO = ("pow", "hypot")
INF, NAN = math.inf, math.nan
TINY, LEAST, MOST = 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308
COUNT = 400

ARRAYS = """
void c_exps(int, double *, double);
void c_exps(int count, double *x, double y) { (void)y; own_exps(count, x); }
void c_pows(int, double *, double);
void c_pows(int count, double *x, double y) { own_pows(count, x, y); }
void c_asinhs(int, double *, double);
void c_asinhs(int count, double *x, double y) { (void)y; own_asinhs(count, x); }
void c_two_powers(double *, double);
void c_two_powers(double *x, double y)
{
    const struct two_powers found = own_two_powers(x[0], y, x[1], x[2]);
    x[0] = found.first;
    x[1] = found.second;
}
"""

WRAPPERS = "\n".join(
    ['#include "elementary_arrays.h"']
    + [f"double c_{name}(double); double c_{name}(double x) {{ return own_{name}(x); }}" for name in ONE]
    + [
        f"double c_{name}(double, double); double c_{name}(double x, double y) {{ return own_{name}(x, y); }}"
        for name in TWO
    ]
    + [ARRAYS]
)


@pytest.fixture(scope="module")
def in_c(tmp_path_factory):
    folder = tmp_path_factory.mktemp("elementary")
    (folder / "tables.h").write_text(tables_h())
    (folder / "functions.c").write_text(WRAPPERS + "\n")
    library = folder / "functions.so"
    command = ["gcc", "-O2", *WARNINGS, "-ffp-contract=off", "-fPIC", "-shared", f"-I{FOLDER}", f"-I{folder}"]
    subprocess.run([*command, str(folder / "functions.c"), "-o", str(library), "-lm"], check=True)
    loaded = ctypes.CDLL(str(library))
    found = {}
    for name in (*ONE, *TWO):
        found[name] = getattr(loaded, f"c_{name}")
        found[name].restype = ctypes.c_double
        found[name].argtypes = [ctypes.c_double] * (1 if name in ONE else 2)
    for name in ("exps", "pows", "asinhs"):
        found[name] = getattr(loaded, f"c_{name}")
        found[name].argtypes = [ctypes.c_int, ctypes.POINTER(ctypes.c_double), ctypes.c_double]
    found["two_powers"] = loaded.c_two_powers
    found["two_powers"].argtypes = [ctypes.POINTER(ctypes.c_double), ctypes.c_double]
    return found


def _tanh(x):
    grown = (2 * x).exp()
    return (grown - 1) / (grown + 1)


def _asinh(x):
    size = abs(x)
    return (size + (size * size + 1).sqrt()).ln().copy_sign(x)


EXACT = {
    "exp": lambda x: x.exp(),
    "expm1": lambda x: x.exp() - 1,
    "log": lambda x: x.ln(),
    "log1p": lambda x: (1 + x).ln(),
    "log10": lambda x: x.log10(),
    "tanh": _tanh,
    "asinh": _asinh,
    "pow": lambda x, y: (y * x.ln()).exp(),
    "hypot": lambda x, y: (x * x + y * y).sqrt(),
}


def _scaled(rng, low, high):
    return rng.choice((-1.0, 1.0)) * 10.0 ** rng.uniform(low, high)


def _power(rng):
    x = 10.0 ** rng.uniform(-30.0, 30.0)
    return x, rng.uniform(-700.0, 700.0) / max(abs(math.log(x)), 1.0)


DRAWN = {
    "exp": lambda rng: (rng.uniform(-707.0, 709.7),),
    "expm1": lambda rng: (_scaled(rng, -12.0, 2.5),),
    "log": lambda rng: (10.0 ** rng.uniform(-307.0, 308.0),),
    "log near 1": lambda rng: (1.0 + _scaled(rng, -15.0, -0.5),),
    "log1p": lambda rng: (abs(_scaled(rng, -15.0, 10.0)),),
    "log1p below 0": lambda rng: (-(10.0 ** rng.uniform(-15.0, -0.001)),),
    "log10": lambda rng: (10.0 ** rng.uniform(-300.0, 300.0),),
    "tanh": lambda rng: (_scaled(rng, -9.0, 1.3),),
    "asinh": lambda rng: (_scaled(rng, -9.0, 200.0),),
    "pow": _power,
    "pow near 1": lambda rng: (1.0 + _scaled(rng, -6.0, -1.0), rng.uniform(-300.0, 300.0)),
    "hypot": lambda rng: (_scaled(rng, -150.0, 150.0), _scaled(rng, -3.0, 3.0)),
    "hypot of alike": lambda rng: (_scaled(rng, -1.0, 1.0), _scaled(rng, -1.0, 1.0)),
}


@pytest.mark.parametrize("case", DRAWN)
def test_an_error_is_at_most_two_units_in_the_last_place(in_c, case):
    name, rng, worst = case.split()[0], random.Random(case), 0.0
    with localcontext() as context:
        context.prec = 60
        for _ in range(COUNT):
            given = DRAWN[case](rng)
            exact = EXACT[name](*map(Decimal, given))
            found = in_c[name](*given)
            worst = max(worst, float(abs(Decimal(found) - exact) / Decimal(math.ulp(float(exact)))))
    assert worst <= 2.0


EDGES = [
    ("exp", (0.0,), 1.0),
    ("exp", (-0.0,), 1.0),
    ("exp", (INF,), INF),
    ("exp", (-INF,), 0.0),
    ("exp", (NAN,), NAN),
    ("exp", (709.782712893384,), math.exp(709.782712893384)),
    ("exp", (709.782712893385,), INF),
    ("exp", (-745.2,), 0.0),
    ("exp", (-745.0,), 5e-324),
    ("exp", (TINY,), 1.0),
    ("expm1", (0.0,), 0.0),
    ("expm1", (1e-300,), 1e-300),
    ("expm1", (INF,), INF),
    ("expm1", (-INF,), -1.0),
    ("expm1", (-1e3,), -1.0),
    ("expm1", (NAN,), NAN),
    ("log", (1.0,), 0.0),
    ("log", (0.0,), -INF),
    ("log", (-1.0,), NAN),
    ("log", (INF,), INF),
    ("log", (NAN,), NAN),
    ("log", (TINY,), math.log(TINY)),
    ("log", (MOST,), math.log(MOST)),
    ("log1p", (0.0,), 0.0),
    ("log1p", (1e-300,), 1e-300),
    ("log1p", (-1.0,), -INF),
    ("log1p", (-2.0,), NAN),
    ("log1p", (INF,), INF),
    ("log1p", (NAN,), NAN),
    ("log10", (1000.0,), 3.0),
    ("tanh", (0.0,), 0.0),
    ("tanh", (1e-300,), 1e-300),
    ("tanh", (INF,), 1.0),
    ("tanh", (-INF,), -1.0),
    ("tanh", (NAN,), NAN),
    ("asinh", (0.0,), 0.0),
    ("asinh", (1e-300,), 1e-300),
    ("asinh", (INF,), INF),
    ("asinh", (-INF,), -INF),
    ("asinh", (NAN,), NAN),
    ("asinh", (MOST,), math.asinh(MOST)),
    ("pow", (0.0, 0.0), 1.0),
    ("pow", (0.0, 2.0), 0.0),
    ("pow", (0.0, -1.0), INF),
    ("pow", (1.0, NAN), 1.0),
    ("pow", (NAN, 0.0), 1.0),
    ("pow", (NAN, 1.5), NAN),
    ("pow", (2.0, NAN), NAN),
    ("pow", (-1.0, 0.5), NAN),
    ("pow", (INF, 2.0), INF),
    ("pow", (INF, -2.0), 0.0),
    ("pow", (2.0, INF), INF),
    ("pow", (0.5, INF), 0.0),
    ("pow", (10.0, 400.0), INF),
    ("pow", (10.0, -400.0), 0.0),
    ("pow", (2.0, -1074.0), TINY),
    ("pow", (TINY, 0.5), math.sqrt(TINY)),
    ("pow", (1e300, 1e300), INF),
    ("hypot", (0.0, 0.0), 0.0),
    ("hypot", (INF, 1.0), INF),
    ("hypot", (-INF, NAN), INF),
    ("hypot", (NAN, 1.0), NAN),
    ("hypot", (1.0, NAN), NAN),
    ("hypot", (3e300, 4e300), 5e300),
    ("hypot", (3e-310, 4e-310), 5e-310),
]


@pytest.mark.parametrize(("name", "given", "expected"), EDGES)
def test_an_edge_is_as_in_c99(in_c, name, given, expected):
    found = in_c[name](*given)
    assert (
        math.isnan(found)
        if math.isnan(expected)
        else abs(found - expected) <= 2.0 * math.ulp(expected) or found == expected
    )


ENDS = (0.0, -0.0, TINY, 1e-310, LEAST, MOST, INF, -INF, NAN, 1.0, -1.0, 707.9, -707.9, 709.0, -745.0, 1e150, -1e150)


@pytest.mark.parametrize("exponent", [0.7061309310834185, -1.5, 300.0, 0.0, INF, NAN])
@pytest.mark.parametrize("name", ["exp", "pow", "asinh"])
def test_an_array_has_the_bits_of_its_numbers_one_by_one(in_c, name, exponent):
    rng = random.Random(name)
    drawn = [_scaled(rng, -9.0, 2.5) for _ in range(COUNT)]
    given = [x for pair in pairwise(drawn) for x in pair]  # both places of a pair
    given += [x for end in ENDS for other in (*ENDS, 0.5, 2.0, 300.0) for x in (end, other, other, end)]
    given.append(2.5)  # one alone at the end
    array = (ctypes.c_double * len(given))(*given)
    in_c[f"{name}s"](len(given), array, exponent)
    one_by_one = [in_c[name](x, exponent) if name == "pow" else in_c[name](x) for x in given]
    assert [x.hex() for x in array] == [x.hex() for x in one_by_one]


def test_two_powers_have_the_bits_of_each(in_c):
    rng = random.Random(5)
    drawn = [(*_power(rng), *_power(rng)) for _ in range(COUNT)]
    exponents = (0.7, -2.0, 0.0, INF, NAN)
    drawn += [(x, a, y, b) for x in ENDS for y in (*ENDS, 3.0) for a, b in pairwise(exponents)]
    for x, a, y, b in drawn:
        both = (ctypes.c_double * 3)(x, y, b)
        in_c["two_powers"](both, a)
        assert [both[0].hex(), both[1].hex()] == [in_c["pow"](x, a).hex(), in_c["pow"](y, b).hex()], (x, a, y, b)
