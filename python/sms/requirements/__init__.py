"""Table 2.1 as a computed compliance table: what is asked, what this machine gives, what limits it.

Range, rate, acceleration and load come from the mechanism, the valve's flow and the supply's force,
all by the core; accuracy and bandwidth of the loop from runs of the whole plant. SI units.
"""

from sms.requirements.compliance import compliance
from sms.requirements.mechanism import best_height
from sms.requirements.table import ACCURACY, REQUIRED, SPECIFIED, Compliance, Row

__all__ = ["ACCURACY", "REQUIRED", "SPECIFIED", "Compliance", "Row", "best_height", "compliance"]
