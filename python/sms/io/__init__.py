"""Reading and writing: rig files (TOML), records (CSV, .mat, Parquet), and the data check.

The road: `load_rig` reads the rig file and finds its records, `load_record` gives each signal as an
array in SI units, `check_rig` and `check_record` say what is wrong with them.
"""

from sms.errors import InputError
from sms.io.check import check_record, check_rig, raise_if_unusable
from sms.io.declarations import Declaration
from sms.io.records import Finding, Record, load_record
from sms.io.rig import RecordSource, Rig, load_rig
from sms.io.signal_sources import SignalSource
from sms.io.write import (
    write_bytes_atomically,
    write_extended_rig,
    write_parquet,
    write_record,
    write_table,
    write_text_atomically,
)

__all__ = [
    "Declaration",
    "Finding",
    "InputError",
    "Record",
    "RecordSource",
    "Rig",
    "SignalSource",
    "check_record",
    "check_rig",
    "load_record",
    "load_rig",
    "raise_if_unusable",
    "write_bytes_atomically",
    "write_extended_rig",
    "write_parquet",
    "write_record",
    "write_table",
    "write_text_atomically",
]
