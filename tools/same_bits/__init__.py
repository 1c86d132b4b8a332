"""Whether two builds compute the same, to the last bit: simulation and estimation over drawn machines.

python -m tools.same_bits record before.json      with the one build
python -m tools.same_bits compare before.json     with the other; exit status 1 where a result differs

A change of how the core is compiled, or of code that is meant to leave every equation as it is, has to pass. Each run
stands with a hash of all of its numbers, so a difference has the name of the run that shows it.
"""
