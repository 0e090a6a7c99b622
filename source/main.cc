// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/program.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

#if defined(__linux__)
#  include <sys/mman.h>
#endif

// Large arrays have large pages. The matrix and the columns of cells are made
// anew in each step, and small pages are more than half of the time of two
// million cells (doc/performance.md, Large pages). glibc would ask for them,
// but only if an environment variable says so before the program starts, and
// not at the ends of an array. Programs that are linked to the library keep
// their own operator new, and so does AddressSanitizer.
#if defined(MADV_HUGEPAGE) && !defined(__SANITIZE_ADDRESS__)
namespace
{
  constexpr std::size_t large_page = std::size_t(1) << 21; // bytes

  /** Bytes of large pages that an array of @p size bytes is to have. The last
   *  page is a large one, too, if that adds no more than an eighth: ranks have
   *  many arrays of about a page. */
  std::size_t
  in_large_pages(const std::size_t size)
  {
    const std::size_t whole = size / large_page * large_page;
    return whole + large_page - size <= size / 8 ? whole + large_page : whole;
  }

  /** An array of which @p large bytes, from its begin on, are in large pages.
   *  That is a wish: where it is not granted, pages are small.
   *  @return null if there is no memory */
  void *
  allocate(const std::size_t size, const std::size_t large)
  {
    if (large == 0)
      return std::malloc(size > 0 ? size : 1);
    void *array = nullptr;
    if (posix_memalign(&array, large_page, std::max(size, large)) != 0)
      return nullptr;
    madvise(array, large, MADV_HUGEPAGE);
    return array;
  }
} // namespace

// Not inlined: GCC would take malloc and operator delete for a pair that does
// not match.
[[gnu::noinline]] void *
operator new(const std::size_t size)
{
  for (;;)
    {
      if (void *const array = allocate(size, in_large_pages(size)))
        return array;
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
