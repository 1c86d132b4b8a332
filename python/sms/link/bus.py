"""Opening a CAN bus by the name of its interface, with python-can."""

from __future__ import annotations

import contextlib
import io
import logging
from dataclasses import dataclass
from typing import Any

import can

from sms.errors import InputError, did_you_mean

BITRATE = 500_000  #: bit/s, that of libsms/firmware/sms.dbc
#: The group of a bus between processes of one computer: frames leave it with a hop limit of 0.
MULTICAST_GROUP = "239.74.163.2"


@dataclass(frozen=True)
class BusAddress:
    """Which bus: an interface python-can knows, its channel, and the bit rate of a real one."""

    interface: str = "virtual"
    channel: str | None = None  #: None: the usual one; of udp_multicast "239.74.163.2:43114"
    bitrate: int = BITRATE

    def __str__(self) -> str:
        """For a person: "socketcan can0"."""
        return f"{self.interface} {self.options().get('channel', '')}".strip()

    def options(self) -> dict[str, Any]:
        """What python-can is asked for."""
        options: dict[str, Any] = {}
        if self.channel is not None:
            options["channel"] = self.channel
        elif self.interface == "virtual":
            options["channel"] = "sms"
        elif self.interface == "udp_multicast":
            options["channel"] = MULTICAST_GROUP
        elif self.interface == "socketcan":
            options["channel"] = "can0"
        elif self.interface == "pcan":
            options["channel"] = "PCAN_USBBUS1"
        if self.interface == "udp_multicast":
            options |= {"hop_limit": 0, "fd": False}
            # Linux gives a socket the frames of every group joined on its port: the port parts buses.
            group, colon, port = str(options["channel"]).partition(":")
            if colon and port.isdigit():
                options |= {"channel": group, "port": int(port)}
        elif self.interface not in ("virtual", "socketcan"):  # socketcan: `ip link` sets it
            options["bitrate"] = self.bitrate
        return options


def open_bus(address: BusAddress) -> can.BusABC:
    """Open a bus. InputError says which could not be opened, why, and what to do."""
    if address.interface not in can.VALID_INTERFACES:
        raise InputError(
            f"there is no CAN interface '{address.interface}'; "
            f"{did_you_mean(address.interface, sorted(can.VALID_INTERFACES))}"
        )
    options = address.options()
    if "channel" not in options:
        raise InputError(f"the interface {address.interface} needs a channel; give --channel")
    logging.getLogger("can").setLevel(
        logging.ERROR
    )  # drivers' hints; the reason is in our sentence
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # some drivers print while they load
            return can.Bus(interface=address.interface, **options)
    except (can.CanError, OSError, ValueError, ImportError, NotImplementedError) as problem:
        raise InputError(
            f"the bus {address} cannot be opened ({_reason(problem)}); {_remedy(address)}"
        ) from None


def _reason(problem: BaseException) -> str:
    text = problem.strerror if isinstance(problem, OSError) and problem.strerror else str(problem)
    return " ".join(text.split()).rstrip(".") or type(problem).__name__


def _remedy(address: BusAddress) -> str:
    remedies = {
        "socketcan": "bring it up: ip link set CHANNEL up type can bitrate 500000",
        "slcan": "pip install pyserial, and give the port: --channel /dev/ttyACM0",
        "udp_multicast": "pip install 'sms[can]', and give a multicast group: --channel 239.74.163.2",
        "pcan": "install the driver of PEAK, and give the channel: --channel PCAN_USBBUS1",
    }
    return remedies.get(address.interface, "check the driver, --channel and --bitrate")
