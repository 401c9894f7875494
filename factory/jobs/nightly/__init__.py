"""A night: build new inputs, verify kept assets, compare with the night before, report.

What a night leaves lies in ``<output>/nights/<name>/``; times and machines belong there and never
into assets.
"""
