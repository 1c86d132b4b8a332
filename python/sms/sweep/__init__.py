"""Many runs of one scenario with other parameters: `load_sweep`, `run_sweep`, `Sweep`."""

from sms.sweep.plan import Sweep, load_sweep
from sms.sweep.run import run_sweep

__all__ = ["Sweep", "load_sweep", "run_sweep"]
