// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/digest.h>
#include <morula/output/output_file.h>
#include <morula/output/sealed_file.h>

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace Morula
{
  namespace
  {
    const std::string first_line = "Morula snapshot\n";

    /** The seal for what is behind a file's seal.
     *  @throws std::runtime_error if it cannot be read to its end */
    std::string
    seal_of_rest(const std::string &path)
    {
      std::ifstream in(path, std::ios::binary);
      in.seekg(size_of_seal);
      // A file may be larger than memory, so it is read in parts of a megabyte.
      std::vector<char> buffer(1 << 20);
      Digest            digest;
      std::uint64_t     n_bytes = 0;
      while (in)
        {
          in.read(buffer.data(), buffer.size());
          digest.add({buffer.data(), static_cast<std::size_t>(in.gcount())});
          n_bytes += in.gcount();
        }
      if (!in.eof())
        throw std::runtime_error("cannot read the file '" + path + "'");
      std::string text = first_line + "bytes " + std::to_string(n_bytes) +
                         "\nCRC-64/XZ " + digest_text(digest.value()) + '\n';
      // Newlines fill the seal up to its fixed size, so that it can be read as
      // text.
      text.resize(size_of_seal, '\n');
      return text;
    }

    bool
    begins_with(const std::string &text, const std::string &start)
    {
      return text.compare(0, start.size(), start) == 0;
    }
  } // namespace

  void
  seal(const std::string &path)
  {
    // The seal's place was left free by the writer, so nothing moves.
    OutputFile file(path, OutputFile::Mode::complete);
    file.write(seal_of_rest(temporary_path(path)));
    file.commit();
  }

  SealState
  examine_seal(const std::string &path)
  {
    std::ifstream in(path, std::ios::binary);
    // An HDF5 file without a seal is told from other files, as its message says
    // something else.
    if (!in)
      return SealState::missing;
    std::string found(size_of_seal, '\0');
    in.read(found.data(), found.size());
    found.resize(in.gcount());
    if (begins_with(found, "\x89HDF\r\n\x1a\n"))
      return SealState::plain_hdf5;
    if (!begins_with(found, first_line))
      return SealState::foreign;
    // If the file ends within the seal, the number of bytes differs, too.
    return seal_of_rest(path) == found ? SealState::whole : SealState::damaged;
  }
} // namespace Morula
