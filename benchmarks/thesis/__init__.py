"""The shipped cases against the thesis that they are from."""
