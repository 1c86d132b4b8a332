"""What identification and diagnosis share: records held against a model, and what can be said of the fit.

kind               what both ask of a kind of rig: its outputs, its unknown inputs, how its problem is made
windows            records as windows, each simulated from an initial state of its own
chosen_windows     the windows that clipped readings leave
divergence         a simulation that diverges, held within numbers
least_squares      Gauss-Newton within bounds, in few evaluations
nuisance           parameters that may move within what is declared, and what they can undo
block_statistics   statistics of correlated residuals: the unit is a block, not a sample
noise              the noise of a sample, as declared or as neighbours differ
coloured_noise     covariance of an estimate where residuals are correlated
"""
