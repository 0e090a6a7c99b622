// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_posix_file_h
#define morula_output_posix_file_h

#include <cstddef>
#include <string>
#include <string_view>

namespace Morula
{
  /** Whether the file that is open as @p descriptor is the one at the path. */
  bool
  is_open_at(const int descriptor, const std::string &path);

  /**
   * A file open for writing. Unlike a std::ofstream it says why something
   * failed, and can be forced to the disk. Every error is thrown as
   * std::runtime_error with the path and the system's reason.
   */
  class PosixFile
  {
  public:
    enum class Mode
    {
      create,   // an existing file is emptied
      append,   // created where it does not exist
      change,   // must exist, content stays; what is written comes behind it
      overwrite // must exist; what is written comes at its beginning
    };

    PosixFile(const std::string &path, const Mode mode);

    /** Closes without a check, for the way out through an exception. */
    ~PosixFile();

    PosixFile(const PosixFile &) = delete;
    PosixFile &
    operator=(const PosixFile &) = delete;

    /** Adds @p text at the end. */
    void
    write(std::string_view text);

    /** Makes sure that @p size bytes fit on the disk, where it can tell. */
    void
    reserve(const std::size_t size);

    /** Cuts the file to @p size bytes. */
    void
    truncate(const std::size_t size);

    /** Returns when the content is on the disk. */
    void
    sync();

    /**
     * Notices that somebody has deleted the file, or put another one in its
     * place: what is written here is lost then.
     */
    void
    check_in_place() const;

    /** Ends the work on the file. */
    void
    close();

  private:
    [[noreturn]] void
    fail(const std::string &what) const;

    std::string path;
    int         descriptor;
  };
} // namespace Morula

#endif
