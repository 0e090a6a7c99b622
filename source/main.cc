// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/program.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#if defined(__linux__)
#  include <sys/mman.h>
#endif

// Large arrays ask for large pages. The matrix and the columns of cells are
// made anew in each step, and small pages are more than half of the time of two
// million cells (doc/performance.md, Large pages). glibc would ask, but only if
// an environment variable says so before the program starts. Programs that are
// linked to the library keep their own operator new, and so does
// AddressSanitizer.
#if defined(MADV_HUGEPAGE) && !defined(__SANITIZE_ADDRESS__)
namespace
{
  /** For all pages of 2 MB that lie wholly in an array of @p size bytes. */
  void
  ask_for_large_pages(void *const array, const std::size_t size)
  {
    constexpr std::uintptr_t page  = std::uintptr_t(1) << 21;
    const auto               first = reinterpret_cast<std::uintptr_t>(array);
    const std::uintptr_t     begin = (first + page - 1) / page * page;
    const std::uintptr_t     end   = (first + size) / page * page;
    if (begin < end) // a wish: where it is not granted, pages are small
      madvise(reinterpret_cast<void *>(begin), end - begin, MADV_HUGEPAGE);
  }
} // namespace

// Not inlined: GCC would take malloc and operator delete for a pair that does
// not match.
[[gnu::noinline]] void *
operator new(const std::size_t size)
{
  for (;;)
    {
      if (void *const array = std::malloc(size > 0 ? size : 1))
        {
          ask_for_large_pages(array, size);
          return array;
        }
      const std::new_handler handler = std::get_new_handler();
      if (handler == nullptr)
        throw std::bad_alloc();
      handler();
    }
}

[[gnu::noinline]] void
operator delete(void *const array) noexcept
{
  std::free(array);
}

[[gnu::noinline]] void
operator delete(void *const array, std::size_t) noexcept
{
  std::free(array);
}
#endif

int
main(int argc, char *argv[])
{
  return Morula::Program().run(argc, argv);
}
