"""The bus: its one definition, libsms/firmware/sms.dbc, as the package carries it."""

from __future__ import annotations

from pathlib import Path

#: the DBC file; in a checkout a link to libsms/firmware/sms.dbc
DBC_FILE = Path(__file__).with_name("sms.dbc")
