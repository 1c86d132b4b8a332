"""Table 2.1 against what this machine gives (`sms requirements`)."""

from __future__ import annotations

from sms._core import Params
from sms.requirements import compliance
from sms.validation.figures import Row


def table_2_1() -> list[Row]:
    """A row of the compliance table each; it agrees when what is required is met."""
    return compliance_rows(Params(), "requirements, Table 2.1")


def compliance_rows(params: Params, experiment: str) -> list[Row]:
    """The compliance of a machine and its controller."""
    rows = []
    for row in compliance(params).rows:
        remark = f"limited by the {row.limit}: {row.remark}; agrees when the requirement is met"
        if not row.meets(row.specified):
            remark += f"; the specification, {row.specified:.4g} {row.unit}, is not met"
        rows.append(
            Row(
                experiment,
                f"{row.criterion}, {row.axis}",
                row.required,
                row.computed,
                row.unit,
                row.meets(row.required),
                remark,
            )
        )
    return rows
