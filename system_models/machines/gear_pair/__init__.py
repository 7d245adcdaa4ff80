"""Spur gear pair.

    machine    its parts, contacts and connections
    geometry   SpurGearPair: drawing of a pair and what follows for its mesh; the FZG test gears and their load stages
    path       radii, surface speeds and tracks along the path of contact; the stations where contacts are solved
    sharing    load of each pair of teeth: rigid, or by the stiffness of the teeth, with tip relief
    textbook   loss factors, mean friction, flash temperature by textbook formulas
    mesh       GearMesh: torque and speeds to the stations, their friction and heat back to both shafts
    shafts     GearShafts: the rotation of both shafts
    flanks     the contact at a station
    rating     what standards of load capacity ask beside the machine: the table [rating]
    working    a pair at work as these standards see it
    micropitting, scuffing    safety factors by ISO/TS 6336-22, by ISO/TS 6336-20 and -21
    safety     these, and those of a run's own contacts
    record     the results of a run along the path, by load stages
    report     the printed report; pictures: its pictures
    shipped/   the files of gear pairs that come with the package

Body 1 is the pinion, body 2 the wheel. Positions are distances [m] on the line of action from T1, where it touches the
base circle of the pinion. Contact runs from A to E, one pair of teeth alone carries from B to D, C is the pitch point.
Imports run one way: geometry <- path <- sharing, textbook <- mesh; geometry <- shafts; sharing, textbook <- working <-
micropitting, scuffing; these and record <- safety <- report, pictures.
"""
