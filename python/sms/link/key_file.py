"""The file that holds the key of a rig: 32 hexadecimal digits, and nothing else."""

from __future__ import annotations

import stat
from pathlib import Path

from sms.errors import InputError

OCTETS = 16
_MAKE_ONE = "make one with: (umask 077; openssl rand -hex 16 > FILE)"


def read_key(file: Path) -> bytes:
    """The key in a file. InputError says what is wrong with it, never what is in it."""
    try:
        text = file.read_text(encoding="ascii")
    except OSError as problem:
        raise InputError(
            f"the key file {file} cannot be read ({problem.strerror}); check --key-file"
        ) from None
    except UnicodeDecodeError:
        text = ""
    try:
        key = bytes.fromhex(text)
    except ValueError:
        key = b""
    if len(key) != OCTETS:
        raise InputError(f"{file} holds no key of {2 * OCTETS} hexadecimal digits; {_MAKE_ONE}")
    if not any(key):
        raise InputError(f"the key in {file} is zero, which means none; {_MAKE_ONE}")
    return key


def readable_by_others(file: Path) -> str | None:
    """What a person should know when others may read the file; None when they may not."""
    if file.stat().st_mode & (stat.S_IRGRP | stat.S_IROTH):
        return f"others on this computer can read the key in {file}; chmod 600 {file}"
    return None
