"""Models as FMUs for other simulators: `sms export fmu` (docs/fmi.md).

`libsms/fmi` is the binary, which comes with the package; here its modelDescription.xml is written and both are packed.
"""

from sms.fmi.archive import export_fmu
from sms.fmi.binary import KINDS, Variable, variables_of
from sms.fmi.starts import Starts, starts_of_rig

__all__ = ["KINDS", "Starts", "Variable", "export_fmu", "starts_of_rig", "variables_of"]
