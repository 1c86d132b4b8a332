"""Which effects enter the model.

excitation             what a motion must contain for an effect to be identifiable
identifiability        which effects these records can show at all
score_test             score (Lagrange multiplier) tests of all effects, by one linear step
multistart             fits from several initial values, for effects far from the present model
candidates             one round: every effect tested, the promising ones fitted
validation             judgement on the validation records, and ambiguity groups
cross_validation       the same where the validation records are insensitive to an effect
forward_selection      rounds until nothing more is found
backward_elimination   causes judged in the presence of each other
"""
