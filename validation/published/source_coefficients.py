"""Which of the source's coefficients can be read off the source's own kind of test?

    python -m validation.published.source_coefficients [--seed 1]

Every printed triple C, b, m is taken as the truth of a component, the independent simulator makes
the record that the source would have taken of it (100 Hz, 323 Pa of noise, in discharge the sensor's
floor at 100 mbar), and the identification says what can be told from it. Those of the actuator, in
actuator_runs/source_tests.py, are asked by their information.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator

import numpy as np
from sms import _core
from sms.identification.flow import FlowFit, fit_records
from sms.identification.flow_problem import COMPONENT
from sms.identification.flow_record import FlowRecord

from validation.published import source_actuator_tests
from validation.trials.identify_flow import declared
from validation.twins.flow_test import (
    Charging,
    Component,
    delayed,
    duration_of,
    read,
    sensor_of,
    simulate,
)

TABLES = (("iso_0_2_mpa", 286e3, "Table 5.1"), ("iso_0_4_mpa", 486e3, "Table 5.2"))


def records(seed: int) -> Iterator[tuple[str, Component, FlowRecord]]:
    """(table and direction, truth, record) of every printed triple."""
    rng = np.random.default_rng(seed)
    for law, supply, table in TABLES:
        rows = _core.valve_table(law)
        for way in ("charge", "discharge"):
            for i, spool in enumerate(rows["spool"]):
                truth = Component(*(float(rows[f"{way}_{k}"][i]) for k in "Cbm"))
                ideal = Charging(truth, way == "charge", supply, duration=duration_of(float(spool)))
                test = delayed(ideal, rng)
                time, pressure = simulate(test)
                reading = read(pressure, sensor_of(test), rng)
                name = f"{1e3 * spool:.3f} mm"
                yield (
                    f"{table}, {way}",
                    truth,
                    FlowRecord(name, time, reading, None, None, float(spool), supply, 86e3),
                )


def summary(group: list[tuple[Component, FlowFit]]) -> list[str]:
    """One line of the table: C within 1 %, b and m told, and where not."""
    near = sum(abs(f.known[COMPONENT[0]].value / t.conductance - 1.0) < 0.01 for t, f in group)
    cells = [f"{near} of {len(group)}"]
    for name in COMPONENT[1:]:
        told = [f.known[name].identifiable for _, f in group]
        open_ones = [f"{f.record.name}" for (_, f), t in zip(group, told, strict=True) if not t]
        where = f"; not at {', '.join(open_ones)}" if 0 < len(open_ones) <= 6 else ""
        cells.append(f"{sum(told)} of {len(group)}{where}")
    return cells


def main() -> None:
    """Print the tables: the valve's, every m that cannot be told with its interval, the actuator's."""
    parser = argparse.ArgumentParser(prog="python -m validation.published.source_coefficients")
    parser.add_argument("--seed", type=int, default=1)
    made = list(records(parser.parse_args().seed))
    fits = fit_records([record for _, _, record in made], declared)
    groups: dict[str, list[tuple[Component, FlowFit]]] = {}
    for (name, truth, _), fit in zip(made, fits, strict=True):
        groups.setdefault(name, []).append((truth, fit))
    print("| printed in | C within 1 % | b identifiable | m identifiable |")
    print("|---|---|---|---|")
    for name, group in groups.items():
        print(f"| {name} | {' | '.join(summary(group))} |")
    print("\nm that no such test identifies, printed value and interval:\n")
    for name, group in groups.items():
        for truth, fit in group:
            m = fit.known[COMPONENT[2]]
            if not m.identifiable:
                print(
                    f"- {name}, {fit.record.name}: {truth.index:.4g}; {m.lower:.2g} to {m.upper:.2g}"
                )
    print("\n" + "\n".join(source_actuator_tests.table()) + "\n")
    print("\n".join(f"- {text}" for text in source_actuator_tests.untold()))


if __name__ == "__main__":
    main()
