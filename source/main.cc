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

  /**
   * An array that begins with a large page, as the system only gives these to
   * whole pages. The last page is a large one, too, if the array fills half
   * of it. That is a wish: where it is not granted, pages are small.
   * @return null if there is no memory
   */
  void *
  allocate_in_large_pages(const std::size_t size)
  {
    const std::size_t n_pages = (size + large_page / 2) / large_page;
    const std::size_t large   = n_pages * large_page;
    void             *array   = nullptr;
    if (posix_memalign(&array, large_page, std::max(size, large)) != 0)
      return nullptr;
    madvise(array, large, MADV_HUGEPAGE);
    return array;
  }

  void *
  allocate(const std::size_t size)
  {
    return size < large_page / 2 ? std::malloc(size > 0 ? size : 1) :
                                   allocate_in_large_pages(size);
  }
} // namespace

// Not inlined: GCC would take malloc and operator delete for a pair that does
// not match.
[[gnu::noinline]] void *
operator new(const std::size_t size)
{
  for (;;)
    {
      if (void *const array = allocate(size))
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
