// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/large_arrays.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#ifdef __GLIBC__
#  include <malloc.h>
#endif
#ifdef __linux__
#  include <sys/mman.h>
#endif

namespace Morula
{
  void
  map_large_arrays()
  {
#ifdef __GLIBC__
    mallopt(M_MMAP_MAX, 1 << 16);
    mallopt(M_MMAP_THRESHOLD, 1 << 25);
#endif
  }

  void
  ask_for_large_pages([[maybe_unused]] void             *array,
                      [[maybe_unused]] const std::size_t size)
  {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::size_t page = std::size_t(1) << 21;
    if (size < page)
      return;
    const auto first = reinterpret_cast<std::uintptr_t>(array);
    const auto begin = (first + page - 1) / page * page;
    const auto end   = (first + size) / page * page;
    if (begin < end)
      madvise(reinterpret_cast<void *>(begin), end - begin, MADV_HUGEPAGE);
#endif
  }
} // namespace Morula

// AddressSanitizer has its own.
#ifndef __SANITIZE_ADDRESS__
// No library asks for large pages: glibc would, but only if an environment
// variable says so before the program starts. Weak, so that a program may have
// its own; not inlined, as GCC would take malloc and operator delete for a pair
// that does not match.
[[gnu::noinline, gnu::weak]] void *
operator new(const std::size_t size)
{
  for (;;)
    {
      if (void *const array = std::malloc(size > 0 ? size : 1))
        {
          Morula::ask_for_large_pages(array, size);
          return array;
        }
      const std::new_handler handler = std::get_new_handler();
      if (handler == nullptr)
        throw std::bad_alloc();
      handler();
    }
}

[[gnu::noinline, gnu::weak]] void
operator delete(void *array) noexcept
{
  std::free(array);
}

[[gnu::noinline, gnu::weak]] void
operator delete(void *array, std::size_t) noexcept
{
  std::free(array);
}
#endif
