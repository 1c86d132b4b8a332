"""One record of the measured test lung, answered in whole: cause, values, gains, free runs, the extended model.

    python -m validation.measured.lung FOLDER                     the test that was run with the wrong resistor
    python -m validation.measured.lung FOLDER --record air1_pc_1 --declared 7 --out report --picture lung.svg

`./dev trials lung` counts such answers; this shows one of them as its owner sees it. By default that of
wrong_resistor_pc_4: the protocol of test 4 asks for resistor 20, and by mistake it was run with resistor 5. What is
known beside the setting comes from the other records (validation/trials/lung_calibration.py), never from the one that
is judged.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from sms.diagnosis import own
from sms.errors import InputError, did_you_mean
from sms.units_display import format_change, format_estimate

from validation.trials.lung_calibration import Calibration, calibrate, known, noise
from validation.trials.lung_model import ML, TESTS, WINDOW, Setting, Test, model, read_tests

RECORD = "wrong_resistor_pc_4"
"""What others ran by mistake in place of test 4."""
PARAMETERS = {"compliance": "compliance", "resistor": "resistor_drop"}
"""Effect -> what the other records say of it at its true setting."""


def diagnosed(
    declared: Setting, test: Test, calibrations: Sequence[Calibration]
) -> tuple[own.Model, own.Answer]:
    """The lung as it is declared, and what its record says of that."""
    lung = model(known(declared, test, calibrations), noise(test, calibrations))
    return lung, own.diagnose_model(lung, test.records, WINDOW, empirical=True)


def lines(
    lung: own.Model, answer: own.Answer, test: Test, calibrations: Sequence[Calibration]
) -> Iterator[str]:
    """The answer in words and numbers."""
    yield f"{answer.verdict}. {answer.sentence}"
    truth = known(test.truth, test, calibrations)
    for cause in answer.causes:
        for p in cause.parameters:
            if cause.effect in PARAMETERS:
                there = truth[PARAMETERS[cause.effect]]
                sizes = format_estimate(there.value, 0.5 * there.half_width, p.unit, p.name)
                yield f"    {p.name}: {sizes} by the other records with the true setting, {test.truth}"
    for p in answer.refitted:
        change = format_change(p.old_value, p.value, p.standard_error, p.unit, p.name)
        yield f"    beside it {p.name}: {change}"
    for u in answer.undetermined:
        yield f"    {u.sentence}"
    for gains, by in (
        (answer.gain if answer.causes else (), "the causes"),
        (answer.empirical.gain if answer.empirical else (), "the curve"),
    ):
        for g in gains:
            yield f"    {g.record}, {g.signal}: {-100.0 * g.reduction:+.0f} % error with {by}"
    for r in answer.free_run:
        yield (
            f"    {r.record}, {r.signal}, a free run: {r.baseline_rms / ML:.1f} ml, "
            f"now {r.extended_rms / ML:.1f} ml"
        )
    if answer.extended is not None:
        before, after = (own.simulate(m, test.whole).error for m in (lung, answer.extended))
        yield (
            f"    all {test.time[-1] - test.time[0]:.0f} s in one free run: {before['volume'] / ML:.1f} ml, "
            f"now {after['volume'] / ML:.1f} ml"
        )


def again(lung: own.Model, answer: own.Answer, test: Test, out: Path) -> str:
    """The extended model from its file, diagnosed on the same records."""
    if not answer.causes:
        return "no cause, and so no extended model to ask again"
    extended = own.read_parameters(out / "extended.toml", lung)
    second = own.diagnose_model(extended, test.records, WINDOW)
    return f"{out.name}/extended.toml, diagnosed again: {second.verdict}. {second.sentence}"


def draw(lung: own.Model, answer: own.Answer, test: Test, picture: Path) -> None:
    """The measured volume and both models' free run, and what either leaves."""
    import matplotlib.pyplot as plt  # noqa: PLC0415 (needed for the picture alone)

    figure, (above, below) = plt.subplots(2, 1, figsize=(8, 5), sharex=True, layout="constrained")
    measured = test.whole.signals["volume"]
    above.plot(test.time, measured / ML, "k", label="measured")
    for label, m in (("as declared", lung), ("extended", answer.extended)):
        if m is not None:
            run = own.simulate(m, test.whole)
            above.plot(run.time, run.outputs["volume"] / ML, label=label)
            below.plot(run.time, (measured - run.outputs["volume"]) / ML, label=label)
    above.set(ylabel="volume [ml]")
    below.set(xlabel="time [s]", ylabel="error [ml]")
    figure.legend(*above.get_legend_handles_labels(), loc="outside upper right", ncols=3)
    figure.savefig(picture)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the answer."""
    parser = argparse.ArgumentParser(prog="python -m validation.measured.lung")
    parser.add_argument("folder", type=Path, help="folder with DAY_pc_N.dat.gz")
    parser.add_argument("--record", default=RECORD)
    parser.add_argument(
        "--declared", type=int, choices=TESTS, help="number of the test whose setting is declared"
    )
    parser.add_argument("--out", type=Path, default=Path("lung"), help="folder for the report")
    parser.add_argument("--picture", type=Path, help="file for the picture, which needs matplotlib")
    options = parser.parse_args(arguments)
    try:
        tests = {t.name: t for t in read_tests(options.folder)}
        if options.record not in tests:
            raise InputError(
                f"{options.folder}: there is no record '{options.record}'; {did_you_mean(options.record, tests)}"
            )
        test = tests[options.record]
        declared = TESTS[options.declared or int(test.name.rpartition("_")[2])]
        calibrations = [calibrate(t) for t in tests.values()]
        lung, answer = diagnosed(declared, test, calibrations)
    except InputError as error:
        print(f"lung: {error}", file=sys.stderr)
        return 2
    print(f"{test.name}: {declared} declared, {test.truth} set")
    for line in lines(lung, answer, test, calibrations):
        print(line)
    own.write_diagnosis(answer, options.out)
    print(again(lung, answer, test, options.out))
    if options.picture is not None:
        draw(lung, answer, test, options.picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())
