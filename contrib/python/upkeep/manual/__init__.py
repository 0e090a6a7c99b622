# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The pages and the reference of all classes in HTML, made by Doxygen."""
