# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""One HTML page about a run, for morula report.

`tool` is the command; `cells` packs the states for the 3-D view, `curves` and `lineage` draw
pictures, `numbers` and `scene` make tables of a morula.run.Run; `document` puts everything into
page/template.html. What moves is in page/*.js."""
