"""The command `sms`: command.py puts it together, one file a group of commands."""

from sms.cli.command import app, main

__all__ = ["app", "main"]
