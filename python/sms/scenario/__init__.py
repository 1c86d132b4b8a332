"""Scenarios: a TOML file in, a simulated run with its findings out.

The road: `load_scenario`, `command_of`, `run_scenario`, `findings_of`, and `write_run` (report/run_files.py); for the
flow test's tank `run_tank` and `tank_findings`.
"""

from sms.scenario.command import command_of
from sms.scenario.findings import Findings, findings_of
from sms.scenario.load import Scenario, load_scenario, scenario_from
from sms.scenario.plant import run_scenario
from sms.scenario.record import Record
from sms.scenario.sent import Command
from sms.scenario.tank import TankFindings, TankRecord, run_tank, tank_findings

__all__ = [
    "Command",
    "Findings",
    "Record",
    "Scenario",
    "TankFindings",
    "TankRecord",
    "command_of",
    "findings_of",
    "load_scenario",
    "run_scenario",
    "run_tank",
    "scenario_from",
    "tank_findings",
]
