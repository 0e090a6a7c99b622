// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_output_file_h
#define morula_output_output_file_h

#include <morula/base/agreement.h>

#include <mpi.h>

#include <cstddef>
#include <functional>
#include <future>
#include <string>
#include <string_view>
#include <utility>

namespace Morula
{
  /** Whether the file that is open as @p descriptor is the one at @p path. */
  bool
  is_open_at(const int descriptor, const std::string &path);

  /** The name under which a file is written before it is complete:
   *  `path.tmp`. */
  std::string
  temporary_path(const std::string &path);

  /**
   * A file open for writing. Unlike std::ofstream it says why an operation
   * failed, and can force its content to the disk. All members throw a
   * std::runtime_error with the path and the system's reason.
   */
  class OutputFile
  {
  public:
    enum class Mode
    {
      create,  // an existing file is emptied
      append,  // the file is created if it does not exist
      change,  // the file must exist; new text follows its content
      replace, // `path.tmp` is written; commit() gives it the file's name
      complete // the same with an existing `path.tmp`, from its beginning
    };

    OutputFile(const std::string &path, const Mode mode);

    /** Closes the file and ignores errors. A file that was to be replaced stays
     *  as it was, unless commit() was called. */
    ~OutputFile();

    OutputFile(const OutputFile &) = delete;
    OutputFile &
    operator=(const OutputFile &) = delete;

    /** Adds @p text. */
    void
    write(std::string_view text);

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

    /** Forces `path.tmp` to the disk and renames it. A reader sees the old file
     *  or the new one, never a part of it. */
    void
    commit();

  private:
    [[noreturn]] void
    fail(const std::string &what) const;

    std::string path;
    bool        is_temporary; // until commit()
    int         descriptor;
  };

  /** Replaces a whole file; see OutputFile::commit(). */
  void
  write_atomically(const std::string &path, const std::string_view text);


  /**
   * Files that a thread of rank 0 writes while the run goes on. At most one lot
   * of them is in memory. All members are collective.
   */
  class BackgroundFiles
  {
  public:
    explicit BackgroundFiles(const MPI_Comm comm)
      : comm(comm)
    {}

    /**
     * Begins to write, when the lot before is finished.
     * @param write writes the files; only rank 0 calls it. It must not
     *   communicate.
     * @param wait  finishes them, too
     * @throws std::runtime_error as finish(), also about the lot before
     */
    void
    start(std::function<void()> write, const bool wait);

    /** Whether there are files that are not finished. */
    bool
    pending() const
    {
      return is_pending;
    }

    /** Whether there are, and they are written, so that finish() need not wait.
     */
    bool
    written() const;

    /**
     * Waits for the files, if there are any.
     * @throws std::runtime_error on all ranks, with path and reason. The files
     *   are given up then.
     */
    void
    finish()
    {
      if (std::exchange(is_pending, false))
        on_root(comm, [this]() { thread.get(); });
    }

  private:
    const MPI_Comm    comm;
    bool              is_pending = false;
    std::future<void> thread; // on rank 0
  };
} // namespace Morula

#endif
