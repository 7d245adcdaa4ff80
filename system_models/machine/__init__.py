"""Machines of contacts and components, from TOML to a report; `systems/` has those that are shipped.

files        which are shipped; reading: a TOML as an Assembly
assembly     a machine's contacts, components, connections and schedule
ball_on_disc, ball_bearing, gear_pair   the kinds of machines: what each of them consists of (`assemble`)
and `<kind>_report`, what each of them says: tables and pictures
timeline     the duty of a machine
command      what `tribofmu run` does with one; report: its costs
resolve      contact states of a finished run, solved again deterministically
coupling_error   what its communication steps do to its outputs
export       for tools that import SSP
"""
