"""Many frames of one message at once: payloads into columns of signals, by what cantools read from the DBC.

cantools decodes a frame at a time, in microseconds; a day on a bus has tens of millions. The bits of a signal are those
of its definition, so a column of payloads is unpacked by numpy; a test holds the two against each other.
"""

from __future__ import annotations

import numpy as np
from cantools.database.can import Message, Signal
from numpy.typing import NDArray

from sms.arrays import Array

Octets = NDArray[np.uint8]
Flags = NDArray[np.bool_]

_FLOATS = {16: np.float16, 32: np.float32, 64: np.float64}
_WORDS = {16: np.uint16, 32: np.uint32, 64: np.uint64}


def bit_places(signal: Signal) -> list[int]:
    """Where the bits of a signal are, the lowest first; bit 0 of octet n is 8 n."""
    if signal.byte_order == "little_endian":
        return [signal.start + i for i in range(signal.length)]
    places = [signal.start]  # of the highest bit; then down, and on at the top of the next octet
    while len(places) < signal.length:
        last = places[-1]
        places.append(last - 1 if last % 8 else last + 15)
    return places[::-1]


class Payloads:
    """The payloads of frames of one message, (frames, octets) of its length."""

    def __init__(self, message: Message, octets: Octets) -> None:
        """Payloads as they came."""
        self.message = message
        self._bits = np.unpackbits(octets, axis=1, bitorder="little")
        self._by_name = {signal.name: signal for signal in message.signals}

    def column(self, signal: Signal) -> Array:
        """Physical values (frames,) as cantools has them, NaN where the frame does not hold the signal."""
        raw = self._raw(signal)
        length = signal.length
        if signal.is_float:
            with np.errstate(invalid="ignore"):  # some NaNs are signals to numpy; here a NaN is one
                values = raw.astype(_WORDS[length]).view(_FLOATS[length]).astype(np.float64)
        elif signal.is_signed:
            spare = np.uint64(64 - length)
            values = ((raw << spare).view(np.int64) >> np.int64(spare)).astype(np.float64)
        else:
            values = raw.astype(np.float64)
        values = values * float(signal.scale) + float(signal.offset)
        values[~self._holds(signal)] = np.nan
        return np.asarray(values)

    def fit(self) -> Flags:
        """Which frames the message describes (frames,): each multiplexer has a value that it knows."""
        fits = np.full(len(self._bits), not self.message.is_container)
        for chooser in self.message.signals:
            if chooser.is_multiplexer:
                chosen = [
                    i
                    for signal in self.message.signals
                    if signal.multiplexer_signal == chooser.name
                    for i in signal.multiplexer_ids or ()
                ]
                fits &= np.isin(self._raw(chooser), chosen) | ~self._holds(chooser)
        return fits

    def _raw(self, signal: Signal) -> NDArray[np.uint64]:
        raw = np.zeros(len(self._bits), dtype=np.uint64)
        for weight, place in enumerate(bit_places(signal)):
            raw |= self._bits[:, place].astype(np.uint64) << np.uint64(weight)
        return raw

    def _holds(self, signal: Signal) -> Flags:
        if signal.multiplexer_signal is None:
            return np.full(len(self._bits), True)
        chooser = self._by_name[signal.multiplexer_signal]
        chosen = np.isin(self._raw(chooser), list(signal.multiplexer_ids or ()))
        return np.asarray(chosen & self._holds(chooser))
