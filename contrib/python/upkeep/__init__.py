# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What keeps the pages of doc/ true: tools that measure, draw and write their
tables and figures. `renew` calls all of them, from the list in `measured`.

Only Morula's tree has this package; an installation has `morula` alone.
"""
