"""What changed on one machine from diagnosis to diagnosis: `sms history` and `sms compare-diagnoses`.

The road: `read_answer` takes from a diagnosis.json what is compared, `Store` keeps every one in one SQLite file,
`history_of` puts them in the order of their measurement and asks of each size what its course is (trend.py,
change_point.py), and `compare` tests the difference of two (difference.py).
"""

from sms.history.answer import Answer, Estimate, read_answer, read_answers
from sms.history.course import Course
from sms.history.difference import Difference, compare
from sms.history.store import Machine, Store
from sms.history.summary import History, history_of

__all__ = [
    "Answer",
    "Course",
    "Difference",
    "Estimate",
    "History",
    "Machine",
    "Store",
    "compare",
    "history_of",
    "read_answer",
    "read_answers",
]
