# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Which public classes and functions lack a comment, from Doxygen's XML.

Every class and every public function has one, except
- what overrides: the base class says what it does;
- constructors and destructors, and operators;
- accessors: constant functions without arguments, named by what they return;
- declare() of parameters: doc/parameters.md says what the keys mean;
- overloads next to one that has a comment.
"""
from xml.etree import ElementTree


def has_text(element):
    """Whether a brief or a detailed description is there."""
    return any("".join(part.itertext()).strip()
               for name in ("briefdescription", "detaileddescription")
               for part in element.findall(name))


def needs_none(function, owner):
    name = function.findtext("name")
    arguments = function.findtext("argsstring") or ""
    return (function.find("reimplements") is not None
            or "override" in arguments
            or "=delete" in arguments.replace(" ", "")
            or name.lstrip("~") == owner
            or name.startswith("operator")
            or (name == "declare" and owner.endswith("Parameters"))
            or (function.get("const") == "yes"
                and function.find("param") is None))


def place(element):
    location = element.find("location")
    return f"{location.get('file')}:{location.get('line')}"


def undocumented(folder):
    """A line for each, 'file:line: what lacks'."""
    found = set()
    for file in sorted(folder.glob("*.xml")):
        root = ElementTree.parse(file).getroot()
        for compound in root.findall("compounddef"):
            kind = compound.get("kind")
            if kind not in ("class", "struct", "namespace"):
                continue
            whole = compound.findtext("compoundname")
            if kind != "namespace" and compound.get("prot") == "public" and (
                    not has_text(compound)):
                found.add(f"{place(compound)}: {kind} {whole} has no comment")
            functions = [
                member for member in compound.iter("memberdef")
                if member.get("kind") == "function"
                and member.get("prot") == "public"]
            explained = {member.findtext("name") for member in functions
                         if has_text(member)}
            owner = whole.split("<")[0].split("::")[-1]
            for member in functions:
                name = member.findtext("name")
                if name not in explained and not needs_none(member, owner):
                    found.add(f"{place(member)}: {whole}::{name}() has no "
                              "comment")
    return sorted(found)
