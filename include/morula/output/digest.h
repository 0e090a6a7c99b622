// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_digest_h
#define morula_output_digest_h

#include <boost/crc.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace Morula
{
  /**
   * The CRC-64 that xz and Go's hash/crc64 call ECMA (CRC-64/XZ): a number that
   * bytes can be recognised by. It can be continued when bytes are added.
   *
   * It finds any one or two wrong bits and any run of up to 64 wrong bits, and
   * overlooks other damage once in 2^64 cases. HDF5's own Fletcher-32 has half
   * as many bits, leaves the file's structure out, and is read by the library
   * that the damage would crash. SHA-1 is in Boost only as a detail of its
   * UUIDs, whose interface changed in 1.86. Nobody forges snapshots, so that a
   * digest against forgers is not needed.
   */
  class Digest
  {
  public:
    /** Counts further bytes. */
    void
    add(const std::string_view bytes)
    {
      crc.process_bytes(bytes.data(), bytes.size());
    }

    /** Of all bytes so far. */
    std::uint64_t
    value() const
    {
      return crc.checksum();
    }

  private:
    boost::crc_optimal<64, 0x42f0e1eba9ea3693u, ~0ull, ~0ull, true, true> crc;
  };

  /** As 16 hexadecimal digits. */
  std::string
  as_text(const std::uint64_t digest);

  /** As two halves, the upper one first, for a snapshot's integer tables. */
  std::vector<int>
  as_integers(const std::uint64_t digest);

  /** The inverse; of two integers. */
  std::uint64_t
  digest_of_integers(const std::vector<int> &halves);
} // namespace Morula

#endif
