// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_large_arrays_h
#define morula_program_large_arrays_h

#include <cstddef>

namespace Morula
{
  /**
   * Gives arrays of 32 MB and more a memory mapping of their own, which
   * returns to the system when they are freed. That is glibc's default, but
   * SuperLU_DIST, which Trilinos may link, switches it off for the whole
   * process when it is loaded. The holes that such arrays then leave in the
   * heap cost 0.6 GB for a million cells (doc/performance.md, Numbers of
   * cells).
   * A program that calls this has an operator new of its own, too, which calls
   * ask_for_large_pages(), unless the program defines another one.
   */
  void
  map_large_arrays();

  /**
   * Asks for large pages, of 2 MB, for all that lie wholly in an array: some
   * systems give them only to those who ask. The matrix and the columns of
   * cells are made anew in each step, and small pages are much of what that
   * costs (doc/performance.md, Large pages). Does nothing where there are none.
   * @param size in bytes
   */
  void
  ask_for_large_pages(void *array, const std::size_t size);
} // namespace Morula

#endif
