"""What is possible, but more likely not meant: texts with the value, what is usual, and the remedy.

A text names the fields of a scenario, which are the keys of its file. Where the reader gives a number in another way, a
function takes the name of that. The command line prints them as notes. In Python `doubts()` of a scenario, a trace and
a configuration lists them; `simulate`, `study`, `stiffest` and `Device.open` warn.
"""
