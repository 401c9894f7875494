"""The nightly report: the data of one night, and the files that tell of it.

Pages are one file each, without scripts and without anything from the network; the templates escape
everything that comes from inputs.
"""
