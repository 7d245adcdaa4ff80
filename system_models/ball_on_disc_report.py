"""stub"""
from pathlib import Path
def lines(a, ds): return []
def write(a, ds, folder): return []
