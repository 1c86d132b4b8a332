"""Payloads decoded in columns are what cantools decodes one by one."""

from __future__ import annotations

import cantools.database
import numpy as np
import pytest
from cantools.database import DecodeError
from cantools.database.can import Message
from sms.io.can_decode import Payloads
from sms.io.can_frames import lacks_value, load_dbc, no_value

from validation.random_cases import draw

ODD = cantools.database.load_string("""
VERSION ""
BU_: A
BO_ 1 Big: 8 A
 SG_ small : 6|3@0+ (1,0) [0|7] "" A
 SG_ across : 3|17@0- (0.25,-3) [0|0] "" A
 SG_ last : 55|16@0- (-2,7) [0|0] "" A
BO_ 2 Little: 8 A
 SG_ one : 0|1@1- (1,0) [0|0] "" A
 SG_ odd : 5|37@1- (0.001,0) [-1E6|1E6] "" A
 SG_ end : 42|22@1+ (3,-1) [0|0] "" A
BO_ 3 Whole: 8 A
 SG_ whole : 0|64@1- (1,0) [0|0] "" A
BO_ 4 WholeBig: 8 A
 SG_ whole : 7|64@0+ (1,0) [0|0] "" A
BO_ 5 Real: 8 A
 SG_ real : 0|32@1- (2,1) [0|0] "" A
 SG_ real_big : 39|32@0- (1,0) [0|0] "" A
BO_ 6 Long: 8 A
 SG_ long : 0|64@1- (1,0) [0|0] "" A
BO_ 7 Choice: 8 A
 SG_ which M : 0|2@1+ (1,0) [0|0] "" A
 SG_ zero m0 : 8|16@1- (0.1,0) [-100|100] "N" A
 SG_ one m1 : 15|8@0+ (1,0) [0|0] "" A
 SG_ always : 32|16@1- (0.01,0) [-100|200] "degC" A
BO_ 8 Short: 3 A
 SG_ value : 4|20@1+ (1,0) [0|0] "" A
SIG_VALTYPE_ 5 real : 1;
SIG_VALTYPE_ 5 real_big : 1;
SIG_VALTYPE_ 6 long : 2;
""")
MESSAGES = [*ODD.messages, *load_dbc().messages]


@pytest.mark.parametrize("message", MESSAGES, ids=lambda message: message.name)
def test_columns_are_what_cantools_decodes(message: Message) -> None:
    octets = draw(message.name).integers(0, 256, (200, message.length), dtype=np.uint8)
    payloads = Payloads(message, octets)
    columns = {signal.name: payloads.column(signal) for signal in message.signals}
    fits = payloads.fit()
    for i, row in enumerate(octets):
        try:
            one = message.decode_simple(row.tobytes(), decode_choices=False)
        except DecodeError:
            assert not fits[i]
            continue
        assert fits[i]
        for name, column in columns.items():
            expected = float(one[name]) if name in one else np.nan  # type: ignore[arg-type]
            np.testing.assert_equal(column[i], expected, err_msg=f"{message.name}.{name}")


@pytest.mark.parametrize("message", MESSAGES, ids=lambda message: message.name)
def test_what_has_no_value_in_a_column_has_none_alone(message: Message) -> None:
    for signal in message.signals:
        low, high = float(signal.minimum or 0.0), float(signal.maximum or 0.0)
        step = abs(float(signal.scale))
        column = np.array([low - step, low, 0.5 * (low + high), high, high + step, np.nan])
        alone = [no_value(signal, float(value)) for value in column]
        assert lacks_value(signal, column).tolist() == alone
