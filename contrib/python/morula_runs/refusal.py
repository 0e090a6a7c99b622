# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Mistakes in what the user asked for."""


class Refused(Exception):
    """What was given, its value, what is allowed, what to do: found before
    anything is computed."""

    def __init__(self, what, value, allowed, remedy=""):
        super().__init__(f"{what} = '{value}': allowed is {allowed}."
                         + (f" {remedy}" if remedy else ""))
