"""A demonstration: one thing is wrong with a virtual bench actuator, drawn and sealed, and a diagnosis has to name it.

The records are simulated by the package itself: this shows what a diagnosis looks like, not how often it is right. That
is counted by blind trials on independent simulators (validation/trials).
"""

from sms.demo.bench import write_bench
from sms.demo.hidden import HIDEABLE, Hidden, draw_hidden
from sms.demo.sealed import Sealed, open_sealed

__all__ = ["HIDEABLE", "Hidden", "Sealed", "draw_hidden", "open_sealed", "write_bench"]
