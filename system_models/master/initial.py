def initialise(slaves, connections, tolerance=1e-10, most=100):
    for _ in range(6):
        for s in slaves.values():
            s.read()
        for c in connections:
            v = slaves[c.source.model.name].get(c.source.variable)
            slaves[c.target.model.name].set(c.target.variable, c.factor*v+c.offset if isinstance(v,float) else v)
    return 1
