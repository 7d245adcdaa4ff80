"""Rough surfaces of both bodies.

    roughness       generation and statistics
    laid            heights of a file on the nodes, and what a grid shows
    patches         body-fixed patches: heights now, place under the contact, rubbing track
    damage_classes  damage below the patches by classes of points at the regression level, and back
    track_means     from patches to the track means of the regression level and back
    profiles        the rubbed surfaces laid end to end, for profiles and pictures

Heights are metres above the mean plane of a body, positive toward the other body.
"""
