"""What a simulation gets wrong, and why.

pipeline         from a rig file to a Diagnosis (result.py): read, check, investigate, complete
simulated        investigate and complete where a simulation is held against records
strokes          the same where a force balance is, stroke by stroke
hypothesis       which parameters may move, and their fit
other_records    a model on the records that it was not fitted to
preparation      records by role, as problems
reference        what records of the healthy machine tell
evidence         sizes with their standard errors, prediction gains, what is left
free_run         the error of a simulation over each whole record
related_rigs     the causes of one rig followed to its relatives
remainder        what a model leaves, as part of an answer (result.py)
wording          the answer in words; of simulated rigs: wording_simulated
thresholds       every tuning constant, with its origin
effects/         the effects that can be named
selection/       which of them enter the model
adequacy/        whether the extended model is adequate, and the verdict
localisation/    which equation an error comes from
design/          detection limits, the next experiment, what a cause means in closed loop
own/             the same for a model of one's own, written in Python
"""

from sms.diagnosis.pipeline import diagnose
from sms.diagnosis.result import Diagnosis

__all__ = ["Diagnosis", "diagnose"]
