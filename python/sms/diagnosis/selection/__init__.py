"""Which effects enter the model.

excitation             what a motion must contain for an effect to be identifiable
identifiability        which effects these records can show at all
score_test             score (Lagrange multiplier) tests of all effects, by one linear step
finite_steps           effects tried at finite sizes, on an excerpt of the records
candidates             a trial of an effect; one round on a cylinder
forward_selection      rounds on a cylinder until nothing more is found, and the verdict
validation             judgement of a cylinder's trials on the validation records, and ambiguity groups
stepwise               rounds on a simulated rig: selected forward, eliminated backward
pairs                  two causes of which neither stands alone
judgement              judgement of its trials on records of both roles
cross_validation       the same where the validation records are insensitive to an effect
ambiguity              which trials that can be causes these records cannot tell apart
outcome                what the rounds brought
"""
