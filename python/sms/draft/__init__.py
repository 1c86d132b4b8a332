"""A first rig file, from the columns of a user's own records: `sms new`.

The road: `read_columns` gives every column of the records with what its header says, `assign` which column is which
signal, `interpretations` its unit, gauge or absolute and the sensor's zero, `rig_text` the commented file. What cannot
be told from the records is a `Question`; an answer to it, or an option, is `Given`.
"""

from sms.draft.columns import Columns, read_columns
from sms.draft.draft import Draft, draft_rig
from sms.draft.given import Given, Question

__all__ = ["Columns", "Draft", "Given", "Question", "draft_rig", "read_columns"]
