"""What a scene is made of: its laws with their equations, its numbers with their sources, and what it leaves out.

    model       records: sections, laws, values
    scene       the explanation of a scene
    left_out    what a scene leaves out, and what that costs
    trust       range of validity, stated errors, and how to see more of them
    wording     values in units people read
    terminal    an explanation as text

Laws carry their equations, symbols and sources themselves; comments in files carry the sources of numbers
(`contact_core.scene.origins`).
"""
