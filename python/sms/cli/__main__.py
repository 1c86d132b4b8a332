"""`python -m sms.cli` is the command `sms`."""

from sms.cli.command import main

main()
