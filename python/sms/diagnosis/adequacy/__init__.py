"""Whether the extended model is adequate, and the verdict.

lack_of_fit            the prediction error beyond the noise floor
repeatability          the same for strokes: what repeats, what drifts, and the noise floor
subset_estimates       a cause's size in one record, or in any part of the windows
parameter_constancy    whether that size is the same everywhere (Chow)
hysteresis             whether the valve has a play that a cause stands in for
record_consistency     whether the records agree on one value of every parameter
systematic_error       standard errors, where what is left follows the signals
verdict                one of the verdicts, from all of these
"""
