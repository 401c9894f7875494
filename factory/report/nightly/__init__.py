"""The pages of nights: one file each, without scripts, without anything from the network.

Everything that comes from inputs goes through :func:`~.markup.text`.
"""
