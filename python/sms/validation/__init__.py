"""The published experiments, repeated: published figure, computed figure, verdict.

    rows = sms.validation.validate()
    [row.quantity for row in rows if not row.agrees]

The published figures and the bands within which a computed one agrees are data (published.toml);
the runs are scenario files (scenarios/), which `sms simulate` takes too; an experiment is a small
module that runs them and measures. What does not agree is a finding: docs/validation.md.
"""

from sms.validation.experiments import EXPERIMENTS, validate
from sms.validation.figures import FIGURES, Figure, Row, rows_to_json

__all__ = ["EXPERIMENTS", "FIGURES", "Figure", "Row", "rows_to_json", "validate"]
