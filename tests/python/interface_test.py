#!/usr/bin/env python3
"""What gim.py declares for ctypes is what gim/decoder.h says."""

import ctypes
import re
import unittest

from support import ROOT, gim

HEADER = re.sub(r"/\*.*?\*/", " ", (ROOT / "decoder/include/gim/decoder.h").read_text(encoding="utf-8"), flags=re.S)
TYPES = {"uint64_t": ctypes.c_uint64, "uint32_t": ctypes.c_uint32, "int32_t": ctypes.c_int32, "float": ctypes.c_float,
         "double": ctypes.c_double, "size_t": ctypes.c_size_t, "gim_limits": gim._Limits, "gim_box": gim._Box}


def constants():
    named = {}
    for body in re.findall(r"enum\s*\{(.*?)\}", HEADER, re.S):
        named.update((name, int(value, 0)) for name, value in re.findall(r"(GIM_\w+)\s*=\s*(-?\w+)", body))
    return named


def fields_of(struct):
    body = re.search(r"typedef struct %s \{(.*?)\} %s;" % (struct, struct), HEADER, re.S).group(1)
    fields = []
    for kind, names in re.findall(r"(\w+)\s+([^;]+);", body):
        for name, count in re.findall(r"(\w+)(?:\s*\[(\w+)\])?\s*(?:,|$)", names):
            length = constants().get(count) or (int(count) if count else None)
            fields.append((name, TYPES[kind] * length if length else TYPES[kind]))
    return fields


class Interface(unittest.TestCase):
    def test_structs(self):
        for name, struct in (("gim_limits", gim._Limits), ("gim_box", gim._Box), ("gim_info", gim._Info),
                             ("gim_view", gim._View), ("gim_level_info", gim._LevelInfo),
                             ("gim_plane_info", gim._PlaneInfo), ("gim_raster_info", gim._RasterInfo),
                             ("gim_raster_channel", gim._RasterChannel)):
            with self.subTest(name):
                self.assertEqual(struct._fields_, fields_of(name))

    def test_statuses(self):
        statuses = re.search(r"gim_status;\s*enum \{(.*?)\}", HEADER, re.S).group(1)
        named = {name[4:]: int(value) for name, value in re.findall(r"(GIM_\w+)\s*=\s*(-?\d+)", statuses)}
        self.assertGreater(len(named), 10)
        for name, value in named.items():
            self.assertEqual(getattr(gim, name), value)
            self.assertEqual(gim.STATUS_NAMES[value], name.lower().replace("_", "-"))

    def test_kinds(self):
        named = constants()
        self.assertEqual((named["GIM_MAX_LEVELS"], named["GIM_NO_LEVEL"]), (gim._MAX_LEVELS, gim._NO_LEVEL))
        for prefix, names in (("GIM_LAYOUT_", gim._LAYOUTS), ("GIM_CODING_", gim._CODINGS),
                              ("GIM_PLANE_", gim._PLANES), ("GIM_SAMPLE_", gim._SAMPLE_TYPES)):
            of_header = {name[len(prefix):].lower(): value for name, value in named.items() if name.startswith(prefix)}
            self.assertEqual(of_header, {name: number for number, name in enumerate(names)})

    def test_functions(self):
        as_ctypes = {"size_t": ctypes.c_size_t, "uint32_t": ctypes.c_uint32, "gim_status": ctypes.c_int32}
        for name, arguments in re.findall(r"GIM_API\s+[\w ]+\*?\s*(gim_\w+)\((.*?)\);", HEADER, re.S):
            declared = getattr(gim._lib, name, None)
            if declared is None or declared.argtypes is None:
                continue
            wanted = [] if arguments == "void" else [
                ctypes.c_void_p if "*" in argument else as_ctypes[argument.split()[-2]]
                for argument in arguments.split(",")]
            self.assertEqual(list(declared.argtypes), wanted, name)

    def test_every_public_name_is_documented(self):
        for name in gim.__all__:
            thing = getattr(gim, name)
            if callable(thing):
                self.assertTrue((thing.__doc__ or "").strip(), name)


if __name__ == "__main__":
    unittest.main()
