"""Why some published figures do not come out: fits over what may be missing or read differently."""
