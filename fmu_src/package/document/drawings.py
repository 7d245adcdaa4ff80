"""Two drawings: axes and signs, and the meaning of a communication step."""

_ARROW = (
    '<defs><marker id="{0}" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" '
    'orient="auto-start-reverse"><path d="M0 0 8 4 0 8z"/></marker></defs>'
)

SIGNS = f"""<svg class="drawing" viewBox="0 0 520 250" role="img"
aria-label="Ball and disc with axes, speeds and friction">
{_ARROW.format("arrow")}
<rect x="40" y="176" width="360" height="34" class="disc"/>
<path d="M70 176 C100 176 110 160 150 160 L280 168 350 176z" class="oil"/>
<circle cx="220" cy="92" r="76" class="ball"/>
<text x="220" y="84" class="middle">body 1</text><text x="70" y="199">body 2</text>
<g class="line">
<path d="M220 146 h110" marker-end="url(#arrow)"/><path d="M220 192 h80" marker-end="url(#arrow)"/>
<path d="M196 128 h-70" marker-end="url(#arrow)" class="force"/>
<path d="M220 2 v38" marker-end="url(#arrow)"/>
<path d="M430 192 h60" marker-end="url(#arrow)"/><path d="M430 192 v-60" marker-end="url(#arrow)"/>
</g>
<text x="334" y="150">speed_1</text><text x="306" y="197">speed_2</text><text x="230" y="16">load</text>
<text x="122" y="118" class="middle force">friction on body 1</text>
<text x="494" y="197">x</text><text x="426" y="126">z</text>
<text x="40" y="238">speed_1 &gt; speed_2 &gt; 0: friction_force &lt; 0, power_loss &gt; 0</text>
</svg>"""

STEPS = f"""<svg class="drawing" viewBox="0 0 520 230" role="img"
aria-label="Inputs held over steps, outputs at the end of each">
{_ARROW.format("arrow-of-time")}
<g class="line">
<path d="M40 200 h460" marker-end="url(#arrow-of-time)"/>
<path d="M120 204 v-190 M240 204 v-190 M400 204 v-190" class="grid"/>
</g>
<path d="M120 80 H240 V40 H400 V62 H470" class="input"/>
<path d="M120 80 C170 66 200 30 240 40 S330 90 400 62 S450 54 470 56" class="asked"/>
<path d="M120 150 C180 150 200 160 240 164 C250 130 320 124 400 122 C410 134 440 138 470 140" class="output"/>
<circle cx="120" cy="150" r="4"/><circle cx="240" cy="164" r="4"/><circle cx="400" cy="122" r="4"/>
<text x="134" y="96">input, held</text><text x="266" y="84">input of the other model</text>
<text x="252" y="160">outputs, at the end of each step</text>
<text x="120" y="220" class="middle">t</text><text x="240" y="220" class="middle">t + h</text>
<text x="400" y="220" class="middle">t + h + h′</text><text x="500" y="220" class="end">time</text>
</svg>"""
