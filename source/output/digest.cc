// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/digest.h>

#include <array>
#include <cstdio>

namespace Morula
{
  namespace
  {
    /** The generator without its highest term. As in a digest, the highest bit
     *  is the coefficient of x^0. */
    constexpr std::uint64_t generator = 0xc96c5795d7870f42u;

    /** Tables[k][b]: the remainder of byte b with k bytes of zeros behind it.
     */
    using Tables = std::array<std::array<std::uint64_t, 256>, 8>;

    constexpr Tables
    make_tables()
    {
      Tables tables{};
      for (unsigned int byte = 0; byte < 256; ++byte)
        {
          // The remainder of one byte, bit by bit; then with more and more
          // zeros behind it.
          std::uint64_t rest = byte;
          for (unsigned int bit = 0; bit < 8; ++bit)
            rest = (rest >> 1) ^ ((rest & 1) != 0 ? generator : 0);
          tables[0][byte] = rest;
        }
      for (unsigned int k = 1; k < tables.size(); ++k)
        for (unsigned int byte = 0; byte < 256; ++byte)
          {
            const std::uint64_t rest = tables[k - 1][byte];
            tables[k][byte]          = (rest >> 8) ^ tables[0][rest & 255];
          }
      return tables;
    }

    constexpr Tables tables = make_tables();

    /** Eight bytes as a number, the first one its lowest. */
    std::uint64_t
    little_endian(const unsigned char *bytes)
    {
      std::uint64_t number = 0;
      for (unsigned int k = 0; k < 8; ++k)
        number |= std::uint64_t(bytes[k]) << (8 * k);
      return number;
    }
  } // namespace

  void
  Digest::add(const std::string_view bytes)
  {
    const auto *byte = reinterpret_cast<const unsigned char *>(bytes.data());
    const auto *const end  = byte + bytes.size();
    std::uint64_t     rest = remainder;
    // Eight bytes at a time: each has a table of its own, for its distance to
    // the end of the eight, and the results do not wait for each other.
    for (; end - byte >= 8; byte += 8)
      {
        const std::uint64_t word = rest ^ little_endian(byte);
        rest                     = 0;
        for (unsigned int k = 0; k < 8; ++k)
          rest ^= tables[7 - k][word >> (8 * k) & 255];
      }
    // The last few bytes, one at a time.
    for (; byte != end; ++byte)
      rest = (rest >> 8) ^ tables[0][(rest ^ *byte) & 255];
    remainder = rest;
  }

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
} // namespace Morula
