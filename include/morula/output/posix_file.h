// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_posix_file_h
#define morula_output_posix_file_h

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace Morula
{
  /** Whether the file that is open as @p descriptor is the one at @p path. */
  bool
  is_open_at(const int descriptor, const std::string &path);

  /**
   * A file open for writing. Unlike std::ofstream it says why an operation
   * failed, and can force its content to the disk. All members throw a
   * std::runtime_error with the path and the system's reason.
   */
  class PosixFile
  {
  public:
    enum class Mode
    {
      create,   // an existing file is emptied
      append,   // the file is created if it does not exist
      change,   // the file must exist; it keeps its content, new text is added
      overwrite // the file must exist; new text replaces its beginning
    };

    PosixFile(const std::string &path, const Mode mode);

    /** Closes the file, and ignores errors; see close(). */
    ~PosixFile();

    PosixFile(const PosixFile &) = delete;
    PosixFile &
    operator=(const PosixFile &) = delete;

    /** Adds @p text at the end. */
    void
    write(std::string_view text);

    /** Puts @p text in the file's place from byte @p offset on. */
    void
    write_at(std::string_view text, std::uint64_t offset);

    /** Reserves @p size bytes on the disk, where the file system can do that,
     *  so that a full disk is noticed now. */
    void
    reserve(const std::size_t size);

    /** Cuts the file to @p size bytes. */
    void
    truncate(const std::size_t size);

    /** Forces the content to the disk. */
    void
    sync();

    /**
     * Throws if somebody has deleted the file or put another one in its place:
     * then all that is written here would be lost.
     */
    void
    check_in_place() const;

    /** Closes the file, and throws if that fails. */
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
