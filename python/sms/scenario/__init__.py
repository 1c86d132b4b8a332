"""Scenarios: a TOML file in, a simulated run with its findings out.

The road: `load_scenario`, `command_of`, `run_scenario`, `findings_of`, `write_run`.
"""

from sms.scenario.command import command_of
from sms.scenario.findings import Findings, findings_of
from sms.scenario.load import Scenario, load_scenario, scenario_from
from sms.scenario.plant import run_scenario
from sms.scenario.record import Record
from sms.scenario.sent import Command

__all__ = [
    "Command",
    "Findings",
    "Record",
    "Scenario",
    "command_of",
    "findings_of",
    "load_scenario",
    "run_scenario",
    "scenario_from",
]
