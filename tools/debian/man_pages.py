#!/usr/bin/env python3
"""Writes the manual pages of gim, one for each command, from what `gim --help` and `gim COMMAND --help` print.

Usage: man_pages.py PROGRAM FOLDER"""

import re
import subprocess
import sys
from pathlib import Path

HEADINGS = re.compile(r"(Positionals|Options|Subcommands):|\[Option Group: (.*)\]")


def help_of(program, *command):
    run = subprocess.run([program, *command, "--help"], stdout=subprocess.PIPE, check=True, text=True)
    return run.stdout.rstrip("\n").split("\n")


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def entries(lines):
    """(head, text) of the entries of a section: a head at the left, its text beside it or on the next lines."""
    found = []
    for line in lines:
        begins = re.match(r" {2,4}(\S.*)$", line)
        if begins and not line.startswith(" " * 10):
            parts = re.split(r" {2,}", begins.group(1), maxsplit=1)
            found.append([parts[0], parts[1] if len(parts) == 2 else ""])
        elif found:
            found[-1][1] += " " + line.strip()
    return [(head, text.strip()) for head, text in found]


def option_head(head):
    name, _, value = head.partition(" ")
    value = re.sub(r"^(UINT|INT|FLOAT|TEXT):(?=.)", "", value).replace(" REQUIRED", "")
    bold = ", ".join(f"\\fB{escaped(word)}\\fR" for word in name.split(","))
    return bold + (f" \\fI{escaped(value)}\\fR" if value else "")


def footer(lines):
    """Paragraphs, and blocks of indented lines as they are."""
    page, indented = [], False
    for line in lines:
        if line.startswith("  ") and not indented:
            page.append(".nf")
        if not line.startswith("  ") and indented:
            page.append(".fi")
        indented = line.startswith("  ")
        page.append(".PP" if not line.strip() else escaped(line))
    return page + [".fi"] * indented


def usage_at(lines):
    return next(i for i, line in enumerate(lines) if line.startswith("Usage: "))


def sections(lines):
    """Splits what follows the usage into (heading, lines), and the footer."""
    parts, rest = [], []
    for line in lines[usage_at(lines) + 1:]:
        heading = HEADINGS.fullmatch(line)
        if heading and not rest:
            parts.append((heading.group(1) or "Options: " + heading.group(2), []))
        elif parts and not rest and (line.startswith("  ") or not line.strip()):
            parts[-1][1].append(line)
        elif line.strip() or rest:
            rest.append(line)
    return parts, rest


def page(name, lines, version, others):
    usage = usage_at(lines)
    parts, rest = sections(lines)
    called, _, arguments = lines[usage][len("Usage: "):].partition(" [")
    arguments = "[" + arguments
    about = " ".join(lines[:usage])
    summary = re.split(r"\.(?:\s|$)", about)[0]
    summary = summary.removeprefix(name + " ")
    out = [f'.TH {name.upper()} 1 "" "gim {version}" "User Commands"', ".SH NAME",
           f"{escaped(name)} \\- {escaped(summary[0].lower() + summary[1:])}",
           ".SH SYNOPSIS", f"\\fB{escaped(called)}\\fR {escaped(arguments)}",
           ".SH DESCRIPTION", *[escaped(line) for line in lines[:usage]]]
    for heading, body in parts:
        out.append(f'.SH "{heading.upper()}"')
        for head, text in entries(body):
            if head.startswith("["):  # what CLI11 says of a group
                continue
            if heading.startswith("Options: ") and not head.startswith("-"):
                out.append(escaped(f"{head} {text}".strip()) if head != "Options:" else ".PP")
            else:
                out += [".TP", option_head(head), escaped(text)]
    if rest:
        out += [".SH NOTES", *footer(rest)]
    out += [".SH \"SEE ALSO\"", ", ".join(f"\\fB{escaped(other)}\\fR(1)" for other in others if other != name)]
    return "\n".join(out) + "\n"


def main(program, folder):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([program, "--version"], stdout=subprocess.PIPE, check=True, text=True).stdout.split()[-1]
    whole = help_of(program)
    commands = [head for heading, body in sections(whole)[0] if heading == "Subcommands" for head, _ in entries(body)]
    if not commands:
        sys.exit("gim --help lists no commands")
    pages = ["gim"] + [f"gim-{command}" for command in commands]
    for name, command in zip(pages, [[]] + [[command] for command in commands]):
        text = page(name, help_of(program, *command), version, pages)
        (folder / f"{name}.1").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
