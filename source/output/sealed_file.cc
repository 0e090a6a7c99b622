// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/output/output_file.h>
#include <morula/output/sealed_file.h>
#include <morula/output/snapshot.h>

#include <boost/algorithm/string.hpp>

#include <cstdio>
#include <fstream>

namespace Morula
{
  std::string
  digest_text(const std::uint64_t digest)
  {
    char text[32];
    std::snprintf(text,
                  sizeof(text),
                  "%016llx",
                  static_cast<unsigned long long>(digest));
    return text;
  }

  std::vector<int>
  as_integers(const std::uint64_t digest)
  {
    // Snapshots have tables of ints, so a digest is two of them.
    return {static_cast<int>(digest >> 32),
            static_cast<int>(digest & 0xffffffffu)};
  }

  std::uint64_t
  digest_of_integers(const std::vector<int> &halves)
  {
    return (std::uint64_t(static_cast<std::uint32_t>(halves[0])) << 32) |
           static_cast<std::uint32_t>(halves[1]);
  }


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
          digest.process_bytes(buffer.data(), in.gcount());
          n_bytes += in.gcount();
        }
      if (!in.eof())
        throw std::runtime_error("cannot read the file '" + path + "'");
      std::string text = first_line + "bytes " + std::to_string(n_bytes) +
                         "\nCRC-64/XZ " + digest_text(digest.checksum()) + '\n';
      // Newlines fill the seal up to its fixed size, so that it can be read as
      // text.
      text.resize(size_of_seal, '\n');
      return text;
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

  void
  check_seal(const std::string &path)
  {
    // An HDF5 file without a seal is told from other files, as its message says
    // something else.
    std::ifstream in(path, std::ios::binary);
    if (!in)
      throw InputError("--resume",
                       path,
                       "a snapshot that can be read",
                       "There is none: start the run without --resume, "
                       "and with --replace if there are files of it.");
    std::string found(size_of_seal, '\0');
    in.read(found.data(), found.size());
    found.resize(in.gcount());
    if (boost::starts_with(found, "\x89HDF\r\n\x1a\n"))
      refuse_snapshot(path,
                      "a snapshot that begins with a digest (this is the "
                      "HDF5 file of another program, or of a Morula that "
                      "wrote none)");
    if (!boost::starts_with(found, first_line))
      refuse_snapshot(path,
                      "a snapshot of Morula (this file does not begin as "
                      "one)");
    // If the file ends within the seal, the number of bytes differs, too.
    if (seal_of_rest(path) != found)
      refuse_snapshot(path,
                      "an undamaged snapshot (this file's bytes are not "
                      "those that Morula wrote: their digest differs)");
  }
} // namespace Morula
