"""A measured and a simulated record side by side: `compare_files`, `compare_signals`."""

from sms.comparison.files import Comparison, compare_files
from sms.comparison.metrics import (
    FrequencyResponse,
    Metrics,
    compare_signals,
    frequency_response,
    normalised_cross_correlation,
    rising_flanks,
)

__all__ = [
    "Comparison",
    "FrequencyResponse",
    "Metrics",
    "compare_files",
    "compare_signals",
    "frequency_response",
    "normalised_cross_correlation",
    "rising_flanks",
]
