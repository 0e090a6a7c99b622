// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/send_records.h>
#include <morula/base/share.h>
#include <morula/output/digest.h>
#include <morula/output/posix_file.h>
#include <morula/output/sealed_file.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <vector>

namespace Morula
{
  using namespace dealii;

  namespace
  {
    const std::string first_line = "Morula snapshot\n";

    /** What one rank has read of a file. */
    struct Part
    {
      std::uint64_t digest, n_bytes;
    };

    /** Reads bytes [@p begin, @p end) of a file, or as many as it can. */
    Part
    digest_of(const std::string  &path,
              const std::uint64_t begin,
              const std::uint64_t end)
    {
      std::ifstream in(path, std::ios::binary);
      in.seekg(begin);
      // A file may be larger than memory, so it is read in parts of a megabyte.
      std::vector<char> buffer(1 << 20);
      Digest            digest;
      std::uint64_t     n_bytes = 0;
      while (in && begin + n_bytes < end)
        {
          in.read(buffer.data(),
                  std::min<std::uint64_t>(buffer.size(),
                                          end - begin - n_bytes));
          digest.add({buffer.data(), static_cast<std::size_t>(in.gcount())});
          n_bytes += in.gcount();
        }
      return {digest.value(), n_bytes};
    }

    /** Bytes behind a file's seal; 0 without such a file. */
    std::uint64_t
    n_bytes_behind_seal(const std::string &path)
    {
      std::error_code      error;
      const std::uintmax_t size = std::filesystem::file_size(path, error);
      return error || size < size_of_seal ? 0 : size - size_of_seal;
    }

    /** The seal of @p n_bytes. */
    std::string
    seal_text(const std::uint64_t digest, const std::uint64_t n_bytes)
    {
      std::string text = first_line + "bytes " + std::to_string(n_bytes) +
                         "\nCRC-64/XZ " + digest_text(digest) + '\n';
      // Newlines fill the seal up to its fixed size, so that it can be read as
      // text.
      text.resize(size_of_seal, '\n');
      return text;
    }

    /** The seal for what is behind a file's seal, of which each rank reads a
     *  share; none if it cannot be read to its end. Collective. */
    std::optional<std::string>
    seal_of_rest(const std::string &path, const MPI_Comm comm)
    {
      // The size is what the first rank sees; another node may not see all of
      // it yet.
      const std::uint64_t n_bytes =
        Utilities::MPI::broadcast(comm, n_bytes_behind_seal(path));
      const auto [begin, end] = share(n_bytes, comm);
      const std::vector<Part> own{
        digest_of(path, size_of_seal + begin, size_of_seal + end)};
      Digest        digest;
      std::uint64_t n_read = 0;
      // In the order of the ranks the parts are the file.
      for (const std::vector<Part> &parts : gather_everywhere(own, comm))
        {
          digest.add(parts[0].digest, parts[0].n_bytes);
          n_read += parts[0].n_bytes;
        }
      if (n_read != n_bytes)
        return {};
      return seal_text(digest.value(), n_bytes);
    }

    bool
    begins_with(const std::string &text, const std::string &start)
    {
      return text.compare(0, start.size(), start) == 0;
    }

    /** Reads the seal of a file.
     *  @return `whole` if there is one, whatever it says */
    SealState
    read_seal(const std::string &path, std::string &found)
    {
      std::ifstream in(path, std::ios::binary);
      // An HDF5 file without a seal is told from other files, as its message
      // says something else.
      if (!in)
        return SealState::missing;
      found.resize(size_of_seal);
      in.read(found.data(), found.size());
      found.resize(in.gcount());
      if (begins_with(found, "\x89HDF\r\n\x1a\n"))
        return SealState::plain_hdf5;
      return begins_with(found, first_line) ? SealState::whole :
                                              SealState::foreign;
    }
  } // namespace

  void
  seal(const std::string &path, const MPI_Comm comm)
  {
    const std::optional<std::string> text = seal_of_rest(path, comm);
    // The seal's place was left free by the writer, so nothing moves.
    on_root(comm, [&]() {
      if (!text)
        throw std::runtime_error("cannot read the file '" + path + "'");
      PosixFile file(path, PosixFile::Mode::overwrite);
      file.write(*text);
      file.close();
    });
  }

  SealState
  examine_seal(const std::string &path, const MPI_Comm comm)
  {
    std::string found;
    SealState   state = SealState::whole;
    on_root(comm, [&]() { state = read_seal(path, found); });
    state = Utilities::MPI::broadcast(comm, state);
    if (state != SealState::whole)
      return state;
    // If the file ends within the seal, the number of bytes differs, too.
    const bool same = seal_of_rest(path, comm) == found; // on the first rank
    return Utilities::MPI::broadcast(comm, same) ? SealState::whole :
                                                   SealState::damaged;
  }
} // namespace Morula
