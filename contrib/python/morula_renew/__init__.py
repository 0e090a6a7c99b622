# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The pages whose figures are measured, renewed without anybody there."""
