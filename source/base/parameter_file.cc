// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/name_list.h>
#include <morula/base/parameter_keys.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace Morula
{
  namespace
  {
    /** Depth of files that include files. More counts as a circle. */
    constexpr unsigned int max_includes = 20;

    /** Depth of sections in sections. No scene has more than three. */
    constexpr unsigned int max_sections = 20;

    /** Longest line with its continuations, characters. */
    constexpr std::size_t max_line = 10000;

    const std::string byte_order_mark = "\xEF\xBB\xBF";

    std::string
    too_long()
    {
      return "at most " + std::to_string(max_line) + " characters";
    }

    /** A subsection that is open: its name, the line where it begins, and how
     *  far that is indented, characters. */
    struct Open
    {
      std::string name, opening;
      std::size_t indent;
    };

    /** Reads one file line by line and keeps track of the open sections. An
     *  included file has a reader of its own, which begins in the sections that
     *  are open where it is included. */
    struct Reader
    {
      void
      read()
      {
        // Lines are put together while they end with a backslash, then read as
        // one statement. Sections that were open before belong to the file that
        // includes this one, so the file must not close them, and must close
        // all of its own.
        const std::size_t n_outer = open.size();
        std::string       line, part;
        while (std::getline(input, part))
          {
            ++line_number;
            // Some editors write a byte order mark.
            if (line_number == 1 && part.rfind(byte_order_mark, 0) == 0)
              part.erase(0, byte_order_mark.size());
            if (line.empty())
              indent = std::min(part.find_first_not_of(" \t"), part.size());
            boost::trim(part);
            const bool goes_on = !part.empty() && part.back() == '\\';
            if (goes_on)
              part.pop_back();
            line += part;
            if (goes_on)
              continue;
            read_line(line, n_outer);
            line.clear();
          }
        if (input.bad())
          fail(name,
               "a file that can be read to its end",
               "Check its permissions and the disk.");
        // The last line may end with a backslash.
        read_line(line, n_outer);
        if (open.size() > n_outer && !unclosed.name.empty())
          throw InputError(printable(unclosed.opening) + ": subsection '" +
                           printable(unclosed.name) +
                           "' is not closed. Add the missing 'end': by the "
                           "indentation it belongs before line " +
                           std::to_string(unclosed_at) + ".");
        if (open.size() > n_outer)
          throw InputError(printable(open[n_outer].opening) + ": subsection '" +
                           printable(open[n_outer].name) +
                           "' is not closed. Add the missing 'end', of this "
                           "subsection or of one within it; the file ends "
                           "with line " +
                           std::to_string(line_number) + ".");
      }

      void
      read_line(std::string line, const std::size_t n_outer)
      {
        // A comment goes first, then the first word tells the kind of the
        // statement. Both spellings are those of deal.II. What is none of them
        // is refused with a guess at what was meant.
        line = line.substr(0, line.find('#'));
        if (line.size() > max_line)
          fail(line, too_long(), "Shorten the line. Is this a scene?");
        boost::replace_all(line, "\t", " ");
        boost::trim(line);
        const auto        blank = line.find(' ');
        const std::string word  = line.substr(0, blank);
        const std::string rest  = blank == std::string::npos ?
                                    "" :
                                    boost::trim_left_copy(line.substr(blank));

        if (line.empty())
          return;
        else if ((word == "set" || word == "SET") && !rest.empty())
          read_set(rest);
        else if ((word == "subsection" || word == "SUBSECTION") &&
                 !rest.empty())
          {
            open.push_back({rest, place(), indent});
            if (open.size() > max_sections)
              fail(line,
                   "at most " + std::to_string(max_sections) +
                     " subsections in each other",
                   "Is an 'end' missing?");
            add(true, boost::join(names(), "/"), "");
          }
        else if ((word == "include" || word == "INCLUDE") && !rest.empty())
          read_include(rest);
        else if (line == "end" || line == "END")
          {
            if (open.size() == n_outer)
              fail(line,
                   "an 'end' for every 'subsection'",
                   "No subsection is open here: remove the 'end'.");
            // The first 'end' that stands further left than the section that it
            // closes was meant for an outer one.
            if (indent < open.back().indent && unclosed.name.empty())
              {
                unclosed    = open.back();
                unclosed_at = line_number;
              }
            open.pop_back();
          }
        else
          fail(line,
               "'set Key = value', 'subsection Name', 'end' or 'include file'",
               guess(line, word) +
                 "Correct the line, or begin it with '#' if it is a comment.");
      }

      /** The names of the open sections. */
      std::vector<std::string>
      names() const
      {
        std::vector<std::string> list;
        for (const Open &section : open)
          list.push_back(section.name);
        return list;
      }

      /** What the user may have meant by a line that is no statement. */
      static std::string
      guess(const std::string &line, const std::string &word)
      {
        const std::string meant =
          most_similar(word, {"set", "subsection", "end", "include"});
        if (!meant.empty() && meant != word)
          return "Did you mean '" + meant + "'? ";
        if (line.find('=') != std::string::npos)
          return "A line that gives a key its value begins with 'set'. ";
        if (meant.empty())
          return "A section begins with 'subsection' and its name. ";
        return "";
      }

      void
      read_set(const std::string &assignment)
      {
        const auto equals = assignment.find('=');
        if (equals == std::string::npos)
          fail("set " + assignment,
               "'set Key = value'",
               "Put '=' between the key and its value.");
        std::vector<std::string> path = names();
        path.push_back(boost::trim_copy(assignment.substr(0, equals)));
        add(false,
            boost::join(path, "/"),
            boost::trim_copy(assignment.substr(equals + 1)));
      }

      void
      read_include(const std::string &file)
      {
        if (depth >= max_includes)
          fail("include " + file,
               "files that do not include themselves",
               "Break the circle.");
        const auto sibling = std::filesystem::path(name).parent_path() / file;
        // A file is looked for from the working directory and then from beside
        // this file. Names may be too long for a file system.
        std::error_code error; // the name may be too long for a file
        const bool      here  = std::filesystem::exists(file, error);
        const auto      found = here ? file : sibling.string();
        std::ifstream   stream(found);
        if (!stream || !std::filesystem::is_regular_file(found, error))
          fail("include " + file,
               "a file that can be read",
               "Correct the name; it counts from the working directory or from "
               "this file.");
        Reader{stream, found, statements, open, depth + 1}.read();
      }

      void
      add(const bool         is_section,
          const std::string &path,
          const std::string &value)
      {
        statements.push_back({is_section, path, value, place() + ": "});
      }

      std::string
      place() const
      {
        return name + ":" + std::to_string(line_number);
      }

      [[noreturn]] void
      fail(const std::string &what,
           const std::string &allowed,
           const std::string &remedy) const
      {
        throw InputError(place(), what, allowed, remedy);
      }

      std::istream           &input;
      const std::string       name;
      std::vector<Statement> &statements;
      std::vector<Open>       open        = {}; // the outermost first
      const unsigned int      depth       = 0;
      unsigned int            line_number = 0;
      std::size_t             indent      = 0;  // of the statement, characters
      Open                    unclosed    = {}; // by the indentation
      unsigned int            unclosed_at = 0;
    };

    /** Why a file cannot be a scene; empty if it can. */
    std::string
    why_no_scene(const std::string &file)
    {
      std::error_code error;
      if (std::filesystem::is_directory(file, error))
        return "It is a directory: name the .prm file in it. ";
      if (std::filesystem::exists(file, error))
        {
          if (!std::ifstream(file))
            return "It exists, but must not be read: check its permissions. ";
          return "";
        }
      if (std::filesystem::exists(file + ".prm", error))
        return "Did you mean '" + file + ".prm'? ";
      return "There is no such file. ";
    }
  } // namespace


  std::vector<Statement>
  read_statements(std::istream &input, const std::string &name)
  {
    std::vector<Statement> statements;
    Reader{input, name, statements}.read();
    return statements;
  }


  std::vector<Statement>
  read_statements(const std::string &file)
  {
    // A directory opens as a stream, so it is asked for by itself.
    std::ifstream input(file);
    if (const std::string reason = why_no_scene(file);
        !input || !reason.empty())
      throw InputError("The scene file",
                       file,
                       "a .prm file that can be read",
                       reason +
                         "Correct its name; 'morula --parameters' prints a "
                         "complete one to start from.");
    return read_statements(input, file);
  }


  Statement
  read_override(const std::string &text)
  {
    if (text.size() > max_line)
      throw InputError("-s", text, too_long(), "Shorten it.");
    // An override is a whole path with its value. It has no sections around it.
    const auto equals = text.find('=');
    if (equals == std::string::npos)
      throw InputError("-s",
                       text,
                       "\"Section/Key=value\"",
                       "Put '=' between the key and its value, and quote the "
                       "whole for the shell.");
    std::vector<std::string> path;
    const std::string        key = text.substr(0, equals);
    boost::split(path, key, boost::is_any_of("/"));
    for (std::string &name : path)
      boost::trim(name);
    return {false,
            boost::join(path, "/"),
            boost::trim_copy(text.substr(equals + 1)),
            "-s: "};
  }
} // namespace Morula
