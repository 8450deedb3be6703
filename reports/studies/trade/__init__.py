"""The report on work and precision: what each decade of accuracy costs, method by method."""
