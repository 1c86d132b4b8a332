"""The desk's side of the CAN bus: a link with a rig, and a virtual rig to try all on.

    with open_bus(BusAddress("socketcan", "can0")) as bus, RigLink(bus) as link:
        link.connect()
        print(drive(link, read_motion(Path("swell.csv"))).summary())

`bus` opens any interface that python-can has; `codec` packs frames by libsms/firmware/sms.dbc; `rig_link` is a desk in
control, `parameters`, `motion` and `drive` what it does; `replay` sends a log again (io/can_files.py); `virtual_rig`,
`real_time` and `faulty_bus` stand in for a rig and for what goes wrong between it and a desk.
"""
