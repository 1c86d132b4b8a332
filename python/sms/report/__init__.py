"""The parts of the HTML page of a diagnosis; sms.diagnosis.report puts them together."""
