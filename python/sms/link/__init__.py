"""The desk's side of the CAN bus: logs, commands to a rig, and a virtual rig to try them on."""
