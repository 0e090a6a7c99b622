# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What the tests in Python share. contrib/python/launch and ctest know where
this package is."""
