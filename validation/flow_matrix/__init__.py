"""The source's test matrix of the flow through its valve, made by an independent simulator."""
