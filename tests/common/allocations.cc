// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "common/allocations.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace
{
  std::atomic<std::size_t> n_bytes(0);
} // namespace


std::size_t
bytes_asked_for()
{
  return n_bytes;
}


// These count; else they do what those of the standard library do.
void *
operator new(const std::size_t n)
{
  n_bytes += n;
  if (void *const place = std::malloc(std::max<std::size_t>(n, 1)))
    return place;
  throw std::bad_alloc();
}


void
operator delete(void *const place) noexcept
{
  std::free(place);
}


void
operator delete(void *const place, std::size_t) noexcept
{
  std::free(place);
}
