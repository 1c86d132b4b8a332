"""The demonstration: an effect that the diagnosis does not know is hidden in records, and has to be found.

./dev demo            records made by the independent simulator in validation/trials
./dev demo --real     the measured cylinder
"""

from __future__ import annotations

import argparse
import secrets
import shutil
import sys
import tempfile
from pathlib import Path

from rich.console import Console
from sms.data import cylinder_rig
from sms.diagnosis import Diagnosis, diagnose
from sms.errors import InputError
from sms.io.write import check_output_folder
from sms.report.console import print_diagnosis
from sms.report.files import write_diagnosis

from validation.trials.cylinder import key_of
from validation.twins.cylinder import effects
from validation.twins.cylinder.draw import draw, open_truth


def run(rig: Path, out: Path, seed: int, console: Console) -> Diagnosis:
    with console.status("diagnosing"):
        answer = diagnose(rig, seed)
        files = write_diagnosis(answer, rig, out)
    print_diagnosis(answer, console)
    console.print(f"\nreport: [bold]{files[0]}[/bold]", soft_wrap=True)
    return answer


def hidden_effect(out: Path, seed: int, console: Console) -> None:
    """Hide, seal, diagnose, then open the truth and print it next to the verdict."""
    with tempfile.TemporaryDirectory() as folder:
        truth_file = Path(folder) / "truth.json"
        records = out / "records"
        if records.exists():
            shutil.rmtree(records)
        with console.status("measuring a virtual cylinder that hides one effect"):
            draw(seed, records, truth_file, _one_of_the_catalogue(seed))
        console.print(f"Records of a virtual cylinder (seed {seed}): {records}", soft_wrap=True)
        console.print(
            f"What is hidden in them is sealed: sha256 {(records / 'truth.sha256').read_text().strip()}\n",
            soft_wrap=True,
        )
        answer = run(records / "rig.toml", out, seed, console)
        truth = open_truth(truth_file, records)
    hidden = key_of(truth["effect"], truth["signal"])
    said = (
        " and ".join(
            " or ".join(
                [key_of(c.effect, c.signal), *(key_of(a.effect, a.signal) for a in c.alternatives)]
            )
            for c in answer.causes
        )
        or answer.verdict
    )
    unit = "" if truth["unit"] == "1" else f" {truth['unit']}"
    console.print(f"\nverdict: [bold]{said}[/bold]", soft_wrap=True)
    console.print(f"truth:   [bold]{hidden}[/bold] = {truth['value']:.4g}{unit}", soft_wrap=True)


def _one_of_the_catalogue(seed: int) -> str:
    keys = [effect.key for effect in effects.CATALOGUE]
    return keys[seed % len(keys)]


def real_cylinder(out: Path, console: Console) -> None:
    for name in ("cylinder_o_ring", "cylinder_kdn"):
        console.rule(name)
        run(cylinder_rig(name), out / name, 1, console)


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="./dev demo", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--real", action="store_true", help="the measured cylinder instead of the virtual one"
    )
    parser.add_argument(
        "--seed", type=int, default=None, help="of the virtual cylinder; fresh if left out"
    )
    parser.add_argument(
        "--out", type=Path, default=Path("out/demo"), help="folder for records and report"
    )
    arguments = parser.parse_args()
    console = Console()
    try:
        check_output_folder(arguments.out)
        if arguments.real:
            real_cylinder(arguments.out, console)
        else:
            seed = secrets.randbelow(10**6) if arguments.seed is None else arguments.seed
            hidden_effect(arguments.out, seed, console)
    except InputError as problem:
        print(f"demo: {problem}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
