// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

std::uint64_t
digest_of(const std::string_view bytes)
{
  Digest digest;
  digest.add(bytes);
  return digest.value();
}


TEST(Digest, OfPartsIsThatOfTheWhole)
{
  std::mt19937 generator(1);
  std::string  bytes(3000, ' ');
  for (char &byte : bytes)
    byte = static_cast<char>(generator());
  const std::string_view whole(bytes);
  for (const std::size_t n : {0, 1, 7, 8, 1000, 2999, 3000})
    {
      const auto first = whole.substr(0, n), second = whole.substr(n);
      EXPECT_EQ(joined_digests(digest_of(first),
                               digest_of(second),
                               second.size()),
                digest_of(whole));
    }

  Digest mixed; // bytes and digests in turn
  for (std::size_t begin = 0, n = 1; begin < whole.size(); begin += n, n *= 3)
    {
      const auto part = whole.substr(begin, n);
      if (n % 2 == 0 || begin % 2 == 0)
        mixed.add(part);
      else
        mixed.add(digest_of(part), part.size());
    }
  EXPECT_EQ(mixed.value(), digest_of(whole));
}


TEST(Digest, OfPartsThatAreLong)
{
  const std::string zeros(1 << 24, '\0');
  EXPECT_EQ(joined_digests(digest_of("123456789"),
                           digest_of(zeros),
                           zeros.size()),
            digest_of("123456789" + zeros));
}


TEST(Digest, OfPartsInAnotherOrderIsAnotherOne)
{
  EXPECT_NE(joined_digests(digest_of("abc"), digest_of("de"), 2),
            joined_digests(digest_of("de"), digest_of("abc"), 3));
}
