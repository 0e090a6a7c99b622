// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_atomic_file_h
#define morula_output_atomic_file_h

#include <morula/output/posix_file.h>

#include <string>
#include <string_view>

namespace Morula
{
  /** Where a file is written before it takes its name: `path.tmp`. */
  std::string
  path_aside(const std::string &path);

  /**
   * Forces `path.tmp` to the disk and gives it the name @p path; a reader sees
   * the old file or the new one, never a part.
   * @throws std::runtime_error with the path and the system's reason
   */
  void
  publish(const std::string &path);

  /**
   * A file that replaces the one of the same name only when it is complete. If
   * it is destroyed before commit(), the old file stays and nothing is left
   * aside.
   */
  class AtomicFile
  {
  public:
    /** @throws std::runtime_error, as all members do. */
    explicit AtomicFile(const std::string &path);

    ~AtomicFile();

    /** See PosixFile. */
    void
    write(const std::string_view text);

    /** See PosixFile. */
    void
    reserve(const std::size_t size)
    {
      file.reserve(size);
    }

    /** Puts the written file in its place: until now there was the old one. */
    void
    commit();

  private:
    std::string path;
    PosixFile   file;
    std::string buffer;
    bool        committed = false;
  };

  /** A whole file at once. */
  void
  write_atomically(const std::string &path, const std::string_view text);
} // namespace Morula

#endif
