# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""doc/faq.md: the messages it quotes are those of the sources, and all."""
import re

from tests.common.program import ProgramTest

from tests.common.messages import ROOT, all_literals, said_at_once


def quoted():
    """The parts of messages that the tables of doc/faq.md quote."""
    text = (ROOT / "doc/faq.md").read_text(encoding="utf-8")
    for table in re.findall(r"<!-- messages -->(.*?)<!-- end -->", text,
                            flags=re.S):
        for row in table.strip().splitlines()[2:]:
            for phrase in re.findall(r"`([^`]+)`", row.split(" | ")[0]):
                yield phrase


class Faq(ProgramTest):
    def test_quotes_are_in_the_sources(self):
        phrases = list(quoted())
        self.assertGreater(len(phrases), 100)
        known = all_literals()
        gone = [phrase for phrase in phrases
                if not any(phrase in literal for literal in known)]
        self.assertEqual(gone, [], "no source has these any more")

    def test_every_message_is_quoted(self):
        phrases = list(quoted())
        places = list(said_at_once())
        self.assertGreater(len(places), 80)
        unknown = [(file, words) for file, words in places
                   if not any(phrase in word for phrase in phrases
                              for word in words)]
        self.assertEqual(unknown, [], "doc/faq.md has none of their words")

    def test_no_quote_twice(self):
        phrases = list(quoted())
        twice = sorted({p for p in phrases if phrases.count(p) > 1})
        self.assertEqual(twice, [])

