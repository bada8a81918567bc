"""Renderers that others wrote, asked the questions of a pack. Nothing here is shared with raypencil but its contract."""
