"""Rough surfaces of both bodies.

    roughness     generation and statistics
    patches       body-fixed patches: heights now, place under the contact, rubbing track
    track_means   from patches to the track means of the regression level and back
    profiles      the rubbed surfaces laid end to end, for profiles and pictures
"""
