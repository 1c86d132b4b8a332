"""docs/faults.md states what the application does, row by row."""

from __future__ import annotations

import pytest

from validation.firmware import faults


@pytest.mark.skipif(not faults.PROGRAM.exists(), reason="sms_fault_table is not built: ./dev build")
def test_the_table_of_faults_is_what_the_application_does() -> None:
    found = faults.rows()
    assert [row.name for row in found if not row.as_stated] == []
    assert faults.PAGE.read_text(encoding="utf-8") == faults.page(found), (
        "docs/faults.md is not current: python -m validation.firmware.faults --write"
    )
