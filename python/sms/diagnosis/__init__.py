"""What a simulation gets wrong, and why: the method, step by step.

prepare     the measured records as the core's problem: motion derived, strokes found
catalogue   the effects that can be named (catalogue.toml)
statistics  judgements that respect coloured residuals: strokes are the unit, not samples
kind, kinds     what the method asks of a kind of rig that is simulated, and the kinds there are (kind_bench.py, ...)
repeatability   what repeats, what drifts, and the noise floor
hypothesis  which parameters may move, and their fit; visible: which effects can be seen at all
search, judgement   one round: screening and fits, then held-out judgement and classes
afar        effects that are far from where the model stands
crosswise   judgement of an effect that the records kept aside do not feel
rounds      rounds until nothing more is found, and the verdict
evidence    sizes with honest errors, gains, what is left
method      the whole method, from a rig file to a Diagnosis (result.py)
own         the same for a plant of one's own, written in Python
report, console   the answer for people
"""

from sms.diagnosis.method import diagnose
from sms.diagnosis.result import Diagnosis

__all__ = ["Diagnosis", "diagnose"]
