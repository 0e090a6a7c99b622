// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_atomic_file_h
#define morula_output_atomic_file_h

#include <morula/output/posix_file.h>

#include <string>
#include <string_view>

namespace Morula
{
  /** The name under which a file is written before it is complete:
   *  `path.tmp`. */
  std::string
  temporary_path(const std::string &path);

  /**
   * Forces `path.tmp` to the disk and renames it to @p path. A reader sees the
   * old file or the new one, never a part of it.
   * @throws std::runtime_error with the path and the system's reason
   */
  void
  publish(const std::string &path);

  /**
   * A file that replaces the old one of its name only when it is complete. If
   * this object is destroyed before commit(), the old file stays and the
   * temporary one is removed.
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

    /** Replaces the old file by the written one. */
    void
    commit();

  private:
    std::string path;
    PosixFile   file;
    std::string buffer;
    bool        committed = false;
  };

  /** Writes a whole file at once; see AtomicFile. */
  void
  write_atomically(const std::string &path, const std::string_view text);
} // namespace Morula

#endif
