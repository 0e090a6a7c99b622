# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""One HTML page about a run, for contrib/report.

`tool` is the command; `scene`, `curves`, `lineage`, `effort`, `accuracy` and
`pictures` each make a part of the page from a morula.run.Run; `cells`
packs the states for the 3-D view, `selection` says which of them; `document`
puts everything into page/template.html. What moves is in page/*.js.
"""
