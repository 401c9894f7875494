"""A night: build what is new, verify what is kept, compare with the night before, report.

What a night leaves lies in ``<output>/nights/<name>/``; times and machines belong there and never
into assets.
"""
