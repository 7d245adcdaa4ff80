"""The native flavour: an FMU in C99 for one scene, without Python.

files     the files of an FMU: sources, and the libraries built from them
"""
