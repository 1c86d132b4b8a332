"""A plant of one's own in the diagnosis (docs/own_model.md, python/examples/two_tanks.py).

model       states, inputs, outputs, parameters, the derivative, and the effects that may be missing
compiled    the derivative in C++ or C, from a shared library
fmu_file, fmu_plant, fmu_calls    an FMU as the plant, with a rig file of its own
records     measured runs, from arrays or tables
integrate, delayed, shooting   the model held against the records, window by window
whole_record   a model run over a whole record
as_rig, engine   the same search and judgement as for the rigs of this project
determinacy    what the records cannot tell of the free parameters
answer, curve_term   the extended model, with causes or with a measured curve
"""

from sms.diagnosis.own.answer import Answer, read_parameters
from sms.diagnosis.own.compiled import from_library
from sms.diagnosis.own.engine import diagnose_model, write_diagnosis
from sms.diagnosis.own.fmu_file import diagnose_fmu
from sms.diagnosis.own.model import Effect, Input, Model, Output, Parameter, State, Values
from sms.diagnosis.own.records import Record, read_record
from sms.diagnosis.own.whole_record import Simulation, simulate
from sms.io.rig import Role

__all__ = [
    "Answer",
    "Effect",
    "Input",
    "Model",
    "Output",
    "Parameter",
    "Record",
    "Role",
    "Simulation",
    "State",
    "Values",
    "diagnose_fmu",
    "diagnose_model",
    "from_library",
    "read_parameters",
    "read_record",
    "simulate",
    "write_diagnosis",
]
