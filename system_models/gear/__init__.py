"""Spur gear pairs.

    geometry   SpurGearPair: a pair's drawing and what follows for its mesh; the FZG test gears and their load stages
    path       along the path of contact: radii, surface speeds, tracks; the stations where contacts are solved
    sharing    what each pair of teeth carries: rigid, or by the stiffness of the teeth, with tip relief
    textbook   what engineers compare with: loss factors, mean friction, flash temperature
    mesh       GearMesh: torque and speeds to the stations, their friction and heat back to both shafts
    shafts     GearShafts: the rotation of both shafts

Body 1 is the pinion, body 2 the wheel. Positions are distances [m] on the line of action from T1, where it touches the
base circle of the pinion. Contact runs from A to E, one pair of teeth alone carries from B to D, C is the pitch point.
Imports run one way: geometry <- path <- sharing, textbook <- mesh; geometry <- shafts.
"""
