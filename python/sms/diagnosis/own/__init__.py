"""A plant of one's own in the diagnosis (docs/own_model.md, python/examples/two_tanks.py).

model       states, inputs, outputs, parameters, the derivative, and the effects that may be missing
compiled    the derivative in C++ or C, from a shared library
records     measured runs, from arrays or tables
integrate, shooting   the model held against the records, window by window
engine      the same search and judgement as for the rigs of this project
"""

from sms.diagnosis.own.compiled import from_library
from sms.diagnosis.own.engine import diagnose_model, write_diagnosis
from sms.diagnosis.own.model import Effect, Input, Model, Output, Parameter, State, Values
from sms.diagnosis.own.records import Record, read_record
from sms.io.rig import Role

__all__ = [
    "Effect",
    "Input",
    "Model",
    "Output",
    "Parameter",
    "Record",
    "Role",
    "State",
    "Values",
    "diagnose_model",
    "from_library",
    "read_record",
    "write_diagnosis",
]
