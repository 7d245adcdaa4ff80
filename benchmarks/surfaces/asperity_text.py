"""Sentences of the page of `asperity_layer`, and what is known of the roughness of real steel below some micrometres."""

import numpy as np

from benchmarks.pages import Page

WHAT = (
    "Waves shorter than any grid are in the model by a law of both bodies together: mean pressure s(h) = p0 exp(-h / h0) at the height h above "
    "the floor, and the touching share A(s) of the area. **h is the volume of the room that the touching surfaces leave, per area: the distance of the mean planes of "
    "the deformed surfaces, zero in full contact.** Asperities at the hardness count as closed: metal that is pressed aside keeps its volume. The distance "
    "of the mean planes of the surfaces before they yield is smaller by what they overlap; with it the exponential is two to three times worse as soon as much yields."
)
UNITS = (
    "Lengths are in 1/q, q = 2 pi / longest wavelength, heights in the rms height sigma, pressures and hardnesses in q sigma E'/2, slopes in q sigma. "
    "In these units elastic contact depends on nothing but the shape of the spectrum, plastic contact on one hardness more: waves of 16 to 4 um and of 4 to 1 um are the "
    "same case, and so are all rms heights. Spectra are isotropic and Gaussian between two wavelengths; breadth is the ratio of the two, H the Hurst exponent "
    "(power of a wave as |q|^(-2 (1 + H))), white the same power for each wave. Waves have random phases, so that rms height and slope of each "
    "surface are exact. Pressures are at most the hardness."
)
CONSTANTS = (
    "Elastic contact of self-affine roughness has a p0 that differs by a factor of 1.4 between the breadths of 4 and 16; the law takes the middle, which is 0.08 rms heights of gap to either side. "
    "Where all yields p0 comes to the hardness, and h0 rises by a sixth."
)
LIMITS = """## What it does not hold for

- Pressures above about 0.4 q sigma E'/2: contact becomes full, and its pressure rises above p0 before the room is gone; the formula of the area is up to 12 % high.
- Pressures below about 0.005: few of the highest asperities touch. The law's gap is too large, by 0.1 to 0.2 rms heights at 0.002 and by 0.3 to 0.4 at 0.0005, and the gap depends on how large a
  piece of surface is looked at.
- Other spectra. p0 of elastic contact goes with the rms slope, not with the longest wave: 0.41 to 0.46 E'/2 times the slope of self-affine surfaces, 0.54 and 1.0 of white
  ones. Over a broad white band the longest wave says next to nothing.
- The area of elastic contact goes with the rms slope, too, thus with the shortest wave, of which the law knows nothing: it takes a slope between those of breadths of 4 and 16. Where asperities yield,
  this matters less: the area comes to pressure over hardness.
- Lay, scratches, pores and plateaus: spectra are isotropic and heights Gaussian.
- Unloading and the second pass: flattened asperities then carry the same load elastically, at a smaller gap. The layer has no memory.
- A hardness that rises at small scales, strain hardening, adhesion, and friction in the contact are not in it.
- Oil in the room that is left: trapped, it would carry load of its own."""

CUT = 4.0  # um
AFM = "https://www.nanosurf.com/cn/application/86-surface-roughness-of-steel-balls-for-tribological-testing"
# surface, rms height [nm], over [um], where the figures are from
KNOWN = (
    (
        "steel ball for wear tests, the smoother of two makers",
        1.25 * 6.0,
        50.0,
        f"Sa 6 nm on an AFM image of 50 um, [Nanosurf]({AFM}); rms height 1.25 Sa assumed",
    ),
    ("the same grade of another maker, with pores", 1.25 * 21.0, 50.0, f"Sa 21 nm, [Nanosurf]({AFM})"),
    (
        "steel ball, ISO 3290 grade 5, upper limit",
        1.25 * 14.0,
        80.0,
        "Ra 14 nm, ISO 3290 (table of rgpballs.com); cut-off 80 um assumed",
    ),
    (
        "steel ball, ISO 3290 grade 10, upper limit",
        1.25 * 20.0,
        80.0,
        "Ra 20 nm, ISO 3290 (table of rgpballs.com); cut-off 80 um assumed",
    ),
    ("bearing washer of `azam_case_a`", 127.0, 250.0, "Rq of the scene; cut-off 250 um assumed"),
)


def real_surfaces(page: Page) -> None:
    """Estimate rms heights below 4 um from those of longer waves."""
    page.say("## Roughness of real steel below some micrometres")
    page.say(
        "No published figure was found for the rms height of bearing steel in a band below 4 um. Estimates from figures over longer waves: a self-affine surface has the "
        f"rms height sigma_L ({CUT:g} um / L)^H below {CUT:g} um, if it has sigma_L below L. H 0.5: spectra of ground and lapped stainless steel fall together at short waves, with the "
        "fractal dimension 1.5 of profiles (Majumdar & Tien, Wear 136 (1990) 313, doi:10.1016/0043-1648(90)90154-3), which is H 0.5; H 0.8 is assumed. "
        "A finish that leaves a shorter roll-off than L has more below 4 um than this."
    )
    page.header("surface", "rms nm", "over um", f"below {CUT:g} um at H 0.5, nm", "at H 0.8, nm", "source")
    for name, rms, length, source in KNOWN:
        page.row(name, rms, length, *(round(float(rms * np.power(CUT / length, h)), 1) for h in (0.5, 0.8)), source)
