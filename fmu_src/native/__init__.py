"""The isolated FMU's own library: C sources, what they are built to, and the tool that builds it.

fmi2.c      the functions of FMI 2.0: each finds its instance
instance.c  an instance on the host's side: what is to be sent, its states, its worker
channel_*   a worker's process and the messages to it, by platform
python_*    the interpreter that runs the model, by platform
start.py    what that interpreter runs
build.py    builds binaries/; image.py tells what is in them
"""
