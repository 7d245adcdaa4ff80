"""One contact through its duty, Stribeck curves, and the reports of simulations.

    duty, duty_table              load, speeds and temperature against time: constant, steps, or a CSV
    contact                       a contact's FMU through a duty
    origin                        identity of a contact's run
    assumed                       values that a scene has left to defaults
    causes                        errors at the end of a contact's run, by their causes
    fields, maps                  maps and profiles of a run at some times: collected, and as variables of its result
    panels                        which quantities of a contact are drawn, and in which words
    track_picture                 picture of wear tracks and tribofilms
    trust, flags, verdict         what to trust of a run: lines before and after it; range flags in numbers; how well
                                  its outputs are known
    grown                         why there are tribofilms where solids do not touch
    report                        the printed table and the overview picture of a contact's run
    stribeck, stribeck_report     Stribeck curves at given times of rubbing; their table and picture
    fit, fit_data, fit_model      constants of a scene from measured numbers: the fit, the numbers, the model
    fit_estimate, fit_report      least squares and intervals; table, picture and named set
    workers                       processes or a cluster that solve the parts of maps and sweeps
    map_ranges, map_build         map of a scene: its histories, and the map
    map_report                    what held-back histories say of it
    cosim_report                  tables and picture of any simulated system

A contact is a system of one FMU: the master drives it through its duty.
"""
