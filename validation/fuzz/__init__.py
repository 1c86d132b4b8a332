"""Proves that no input brings a command down: thousands of spoilt ones are answered, or refused in one sentence."""
