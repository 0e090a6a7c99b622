# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The pictures of doc/steps.

`plots` draws what the step programs print, `tissues` what they write; each
function makes the picture of one step.
"""
