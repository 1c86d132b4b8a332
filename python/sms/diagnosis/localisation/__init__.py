"""Which equation an error comes from, and along what it is arranged.

signal_functions    terms of an equation that follow a signal, and their sensitivities
unknown_inputs      unknown inputs estimated in the simulation
equation_error      each equation fed with measured signals, none simulated
activity            when a cause acts, as unknown inputs
residual_spectrum   the prediction error signal by signal, and at which frequencies
ripple              a period along the stroke
empirical_term      the missing term's curve carried along, unexplained
"""
