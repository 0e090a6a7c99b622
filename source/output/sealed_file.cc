// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/digest.h>
#include <morula/output/posix_file.h>
#include <morula/output/sealed_file.h>

#include <fstream>
#include <stdexcept>
#include <vector>

namespace Morula
{
  namespace
  {
    const std::string first_line = "Morula snapshot\n";

    /**
     * The seal for the rest of a stream.
     * @param in stream whose position is behind the seal
     */
    std::string
    seal_of_rest(std::istream &in)
    {
      std::vector<char>  buffer(1 << 20);
      Digest             digest;
      unsigned long long n_bytes = 0;
      while (in.read(buffer.data(), buffer.size()) || in.gcount() > 0)
        {
          digest.add({buffer.data(), static_cast<std::size_t>(in.gcount())});
          n_bytes += in.gcount();
        }
      std::string text = first_line + "bytes " + std::to_string(n_bytes) +
                         "\nCRC-64/XZ " + digest_text(digest.value()) + '\n';
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
    std::ifstream in(path, std::ios::binary);
    in.seekg(size_of_seal);
    if (!in)
      throw std::runtime_error("cannot read the file '" + path + "'");
    const std::string text = seal_of_rest(in);
    if (in.bad())
      throw std::runtime_error("cannot read the file '" + path + "'");
    PosixFile file(path, PosixFile::Mode::overwrite);
    file.write(text);
    file.close();
  }

  SealState
  examine_seal(const std::string &path)
  {
    std::ifstream in(path, std::ios::binary);
    if (!in)
      return SealState::missing;
    std::string found(size_of_seal, '\0');
    in.read(&found[0], found.size());
    found.resize(in.gcount());
    if (begins_with(found, "\x89HDF\r\n\x1a\n"))
      return SealState::plain_hdf5;
    if (!begins_with(found, first_line))
      return SealState::foreign;
    // If the file ends within the seal or cannot be read to its end, the number
    // of bytes differs.
    return found == seal_of_rest(in) ? SealState::whole : SealState::damaged;
  }
} // namespace Morula
