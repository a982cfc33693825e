"""gim: geometry images (.gim files) as numpy arrays.

    surface = gim.open("bunny.gim")               # a path, or bytes, a memoryview, an mmap, an array of bytes
    image = surface.positions(0)                  # 257 x 257 x 3 float32: the geometry image at full resolution
    mesh = surface.mesh(2, normals=True)          # a closed triangle mesh, each side a quarter of the samples
    batch = gim.decode_batch(files, level=1, layout="CHW", threads=4)
    data = gim.encode(vertices, faces, psnr=70)   # bytes of a new file
    data = gim.encode_image(array, mask, lossless=True)   # of a multi-chart image that another program made
    array, mask = gim.open(data).array()          # and that image again

This is the C library of gim/decoder.h through ctypes. The C functions write straight into the arrays that are returned,
and read straight from the bytes that are given. Level 0 is full resolution; each further level halves it. Decoded
floats are the same bits on every machine. Files are taken as hostile: a broken one raises gim.Error. Calls release
Python's lock, and any number of threads may use one object. Do not change bytes while they are being decoded.

The library is libgim-decoder.so.0, or the file that the environment variable GIM_LIBRARY names. gim.encode needs the
program gim, in PATH or named by GIM_PROGRAM.
"""

from __future__ import annotations

import contextlib
import ctypes
import io
import operator
import os
import re
import shutil
import subprocess
import tempfile
import threading
import warnings
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple, Optional, Tuple

import numpy as np

__all__ = ["open", "decode_batch", "encode", "encode_image", "File", "Image", "Box", "Info", "Level", "Plane", "Mesh", "Grid", "Frames",
           "Limits", "Error", "STATUS_NAMES"]

# ---- the C interface -------------------------------------------------------------------------------------------------

_MAX_LEVELS = 14
_ALIGNMENT = 16
_LAYOUTS = ("gim", "mcgim", "tiles")
_CODINGS = ("lossless", "lossy")
_PLANES = ("normals", "colors", "displacements")
_NO_LEVEL = 0x7FFFFFFF

NEED_MORE_INPUT, OK, NOT_GIM, UNSUPPORTED_VERSION, MALFORMED, LIMIT_EXCEEDED = -1, 0, 1, 2, 3, 4
BAD_ARGUMENT, SCRATCH_TOO_SMALL, CHECKSUM, NO_SUCH_LEVEL, NO_SUCH_PLANE = 5, 6, 7, 8, 9
STATUS_NAMES = {-1: "need-more-input", 0: "ok", 1: "not-gim", 2: "unsupported-version", 3: "malformed",
                4: "limit-exceeded", 5: "bad-argument", 6: "scratch-too-small", 7: "checksum", 8: "no-such-level",
                9: "no-such-plane"}

_u32, _u64, _f32, _f64 = ctypes.c_uint32, ctypes.c_uint64, ctypes.c_float, ctypes.c_double


class _Limits(ctypes.Structure):  # gim_limits
    _fields_ = [("max_samples", _u64), ("max_images", _u32), ("max_side", _u32)]


class _Box(ctypes.Structure):  # gim_box
    _fields_ = [("low", _f32 * 3), ("high", _f32 * 3)]


class _Info(ctypes.Structure):  # gim_info
    _fields_ = [("version", _u32), ("layout", _u32), ("coding", _u32), ("bits", _u32), ("image_count", _u32),
                ("level_count", _u32), ("chunk_count", _u32), ("sample_count", _u64), ("file_size", _u64),
                ("origin", _f64 * 3), ("is_relative", _u32), ("step", _f32), ("quantizer", _f32),
                ("index_size", _u32), ("level_rms_error", _f32 * _MAX_LEVELS), ("level_max_error", _f32 * _MAX_LEVELS),
                ("has_boxes", _u32), ("box", _Box), ("limits", _Limits)]


class _View(ctypes.Structure):  # gim_view
    _fields_ = [("distance", _f32), ("vertical_fov", _f32), ("viewport_height", _f32), ("pixel_error", _f32)]


class _LevelInfo(ctypes.Structure):  # gim_level_info
    _fields_ = [("side", _u32), ("width", _u32), ("height", _u32), ("coarsest_level", _u32), ("vertex_count", _u32),
                ("triangle_count", _u32), ("prefix_size", _u64), ("scratch_size", _u64), ("rms_error", _f32),
                ("max_error", _f32), ("box", _Box)]


class _PlaneInfo(ctypes.Structure):  # gim_plane_info
    _fields_ = [("width", _u32), ("height", _u32), ("coarsest_level", _u32), ("quantizer", _f32),
                ("stream_size", _u64), ("prefix_size", _u64), ("scratch_size", _u64)]


class _LabelsInfo(ctypes.Structure):  # gim_labels_info
    _fields_ = [("cell_count", _u32), ("scratch_size", _u64), ("prefix_size", _u64)]


class _RasterInfo(ctypes.Structure):  # gim_raster_info
    _fields_ = [("width", _u32), ("height", _u32), ("channels", _u32), ("sample_type", _u32),
                ("is_channels_first", _u32), ("mask", _u32), ("mask_value", _u32), ("prefix_size", _u64),
                ("scratch_size", _u64)]


class _RasterChannel(ctypes.Structure):  # gim_raster_channel
    _fields_ = [("bits", _u32), ("origin", _f64), ("step", _f64)]


# In the order of GIM_SAMPLE_...
_SAMPLE_TYPES = ("float32", "float64", "float16", "uint8", "int8", "uint16", "int16", "uint32", "int32")


def _load_library():
    name = os.environ.get("GIM_LIBRARY") or "libgim-decoder.so.0"
    try:
        library = ctypes.CDLL(name)
    except OSError as failure:
        raise ImportError(f"gim: cannot load {name} ({failure}); install libgim-decoder0, or let the environment "
                          "variable GIM_LIBRARY name the file") from failure
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    file, scratch = [pointer, pointer, size], [pointer, size]
    surface = [_u32, _u32, pointer, pointer, pointer, pointer] + scratch
    arguments = {
        "gim_read_info": [pointer, size, pointer, pointer],
        "gim_read_level_info": file + [_u32, _u32, pointer],
        "gim_decode_positions": file + [_u32, _u32, pointer] + scratch,
        "gim_decode_mesh": file + surface,
        "gim_decode_hard_mesh": file + [_u32, _u32] + [pointer] * 5 + scratch,
        "gim_decode_grid": file + surface,
        "gim_read_box": file + [_u32, pointer],
        "gim_read_plane_info": file + [_u32, _u32, _u32, pointer],
        "gim_decode_plane": file + [_u32, _u32, _u32, pointer] + scratch,
        "gim_read_labels_info": file + [_u32, _u32, pointer],
        "gim_decode_labels": file + [_u32, _u32, pointer] + scratch,
        "gim_read_raster_info": file + [pointer],
        "gim_read_raster_channel": file + [_u32, pointer],
        "gim_decode_raster": file + [pointer, pointer] + scratch,
        "gim_read_text": file + [pointer, size, pointer] + scratch,
    }
    for function, types in arguments.items():
        getattr(library, function).argtypes = types
        getattr(library, function).restype = ctypes.c_int32
    library.gim_choose_level.argtypes, library.gim_choose_level.restype = [pointer, pointer, _u32], _u32
    library.gim_text_scratch_size.argtypes, library.gim_text_scratch_size.restype = [], size
    library.gim_status_text.argtypes, library.gim_status_text.restype = [ctypes.c_int32], ctypes.c_char_p
    return library


_lib = _load_library()


class Error(Exception):
    """What went wrong with a file, a limit or the program.

    status       the number of gim/decoder.h, as gim.MALFORMED; None if the program `gim encode` failed
    status_name  the same as a word, as "malformed"; None likewise
    item         in decode_batch: the place of the item in the list, from 0 on; else None
    exit_status  in encode: the exit status of the program, 1: it failed, 2: the options are wrong; else None
    """

    def __init__(self, status, message=None, item=None, exit_status=None):
        self.status, self.item, self.exit_status = status, item, exit_status
        self.status_name = None if status is None else STATUS_NAMES.get(status, str(status))
        self.reason = message or _lib.gim_status_text(status).decode()
        super().__init__(status, self.reason, item, exit_status)

    def __str__(self):
        place = "" if self.item is None else f"item {self.item}: "
        return place + self.reason + ("" if self.status is None else f" ({self.status_name})")


def _check(status):
    if status != OK:
        raise Error(status)


# ---- memory ----------------------------------------------------------------------------------------------------------

class Limits(NamedTuple):
    """What a caller accepts. A file beyond it raises gim.Error with gim.LIMIT_EXCEEDED before memory is taken.

    max_samples  of all images of a file together
    max_images   of a file
    max_side     samples along a row or column
    max_memory   bytes of all arrays and scratch that one call takes, the file included if it is read from a path;
                 None: as much as the samples need
    """
    max_samples: int = 2 ** 26
    max_images: int = 65536
    max_side: int = 16385
    max_memory: Optional[int] = None


def _checked(limits):
    limits = Limits() if limits is None else limits
    for name, value, bits in zip(Limits._fields, limits, (64, 32, 32, 64)):
        if value is not None and not 0 <= value < 2 ** bits:
            raise ValueError(f"{name} must be from 0 to 2^{bits} - 1, not {value}")
    return limits


class _Budget:
    """Hands out the memory of one call."""

    def __init__(self, limits):
        self.left = limits.max_memory

    def take(self, size):
        if self.left is None:
            return
        if size > self.left:
            raise Error(LIMIT_EXCEEDED, f"{size} more bytes are needed, and the limit leaves {self.left}")
        self.left -= size

    def array(self, shape, dtype=np.float32):
        self.take(int(np.prod(shape, dtype=np.uint64)) * np.dtype(dtype).itemsize)
        return np.empty(shape, dtype)


def _address(array):
    return None if array is None else array.__array_interface__["data"][0]


class _Scratch:
    """Aligned memory for one thread. It keeps the largest piece that was asked for."""

    def __init__(self, budget):
        self.budget, self.size, self.memory, self.address = budget, 0, None, None

    def reserve(self, size):
        if size <= self.size:
            return
        self.budget.take(size - self.size if self.memory is not None else size + _ALIGNMENT)
        self.memory = None  # before the next piece, so that both are never there
        self.memory = np.empty(size + _ALIGNMENT, np.uint8)
        self.address = -(-_address(self.memory) // _ALIGNMENT) * _ALIGNMENT
        self.size = size


def _read_file(path, limits):
    with _open_file(path, "rb") as file:
        if limits.max_memory is None:
            return file.read()
        data = file.read(limits.max_memory + 1)
    if len(data) > limits.max_memory:
        raise Error(LIMIT_EXCEEDED, f"{os.fspath(path)!r} has more bytes than the limit, {limits.max_memory}")
    return data


def _output(out, shape, budget, dtype=np.float32):
    """Returns the caller's array if there is one, after checks, else a new one."""
    if out is None:
        return budget.array(shape, dtype)
    if not isinstance(out, np.ndarray) or out.dtype != dtype or out.shape != tuple(shape):
        raise ValueError(f"out must be an array of shape {tuple(shape)} and type {np.dtype(dtype)}")
    if not (out.flags.c_contiguous and out.flags.writeable and out.flags.aligned):
        raise ValueError("out must be contiguous, aligned and writeable")
    return out


# ---- what a file holds -----------------------------------------------------------------------------------------------

class Box(NamedTuple):
    """Corners of a box along the axes, in the coordinates of decoded positions."""
    low: Tuple[float, float, float]
    high: Tuple[float, float, float]


def _told_box(box):
    """None if the file does not tell a box: then the decoder gives one without end."""
    return None if box.high[0] >= np.finfo(np.float32).max else Box(tuple(box.low), tuple(box.high))


class Info(NamedTuple):
    """Header and index of a file. Lengths are in the units of the mesh that was encoded."""
    version: int
    layout: str        # "gim": a square for each component; "mcgim": charts in a rectangle; "tiles"
    coding: str        # "lossless" or "lossy"
    bits: int          # per coordinate, of the quantizer
    image_count: int
    level_count: int
    sample_count: int  # of all images at level 0
    file_size: int     # of the whole file, as its index says
    origin: Tuple[float, float, float]
    is_relative: bool  # positions are relative to origin: add it in float64. Else they contain it
    step: float        # length of a quantization step
    quantizer: float
    index_size: int    # a prefix of so many bytes suffices for gim.open
    rms_errors: Tuple[float, ...]  # of levels against the encoder's input, in object units; 0: the file does not say
    max_errors: Tuple[float, ...]  # likewise, the largest distance
    box: Optional[Box]             # holds all images at all levels; None: the file does not say


class Level(NamedTuple):
    """One resolution of an image, or of a file: then counts are sums over its images."""
    level: int
    height: Optional[int]  # samples of the grid; None if the file has several images
    width: Optional[int]
    vertex_count: int
    triangle_count: int
    prefix_size: int       # bytes of the file, from its start, that the level needs
    scratch_size: int      # bytes of memory that decoding takes besides its results
    rms_error: float       # against the encoder's input, in object units; 0: the file does not say
    max_error: float       # likewise, the largest distance


class Plane(NamedTuple):
    """One level of an attribute plane."""
    level: int
    height: int
    width: int
    quantizer: float
    prefix_size: int
    scratch_size: int


class Mesh(NamedTuple):
    """vertices: n x 3 float32. faces: m x 3 uint32, counter-clockwise seen from outside. normals: n x 3 float32 of unit
    length, 0 where the surface has none. texcoords: n x 2 float32, u along columns, v along rows. None: not wanted."""
    vertices: np.ndarray
    faces: np.ndarray
    normals: Optional[np.ndarray]
    texcoords: Optional[np.ndarray]


class Grid(NamedTuple):
    """positions: height x width x 3 float32, NaN where no surface is. normals, texcoords: as many rows and columns.
    faces: m x 3 uint32; sample (row, column) has the number row * width + column. None: not wanted."""
    positions: np.ndarray
    normals: Optional[np.ndarray]
    texcoords: Optional[np.ndarray]
    faces: Optional[np.ndarray]


class Image:
    """One image of a file: a grid of points of the surface."""

    def __init__(self, file, index):
        self._file, self._index = file, index

    def _level(self, level):
        read = _LevelInfo()
        _check(_lib.gim_read_level_info(*self._file._arguments, self._index, _number(level), ctypes.byref(read)))
        return read

    def _plane(self, name, level):
        read = _PlaneInfo()
        _check(_lib.gim_read_plane_info(*self._file._arguments, self._index, _plane_kind(name), _number(level),
                                        ctypes.byref(read)))
        return read

    def _decode(self, function, level, budget, scratch_size, *outputs):
        scratch = _Scratch(budget)
        scratch.reserve(scratch_size)
        _check(function(*self._file._arguments, self._index, _number(level), *outputs, scratch.address, scratch.size))

    def level(self, level):
        """Returns the Level. Raises gim.Error with gim.NO_SUCH_LEVEL beyond the coarsest one."""
        read = self._level(level)
        return Level(level, read.height, read.width, read.vertex_count, read.triangle_count, read.prefix_size,
                     read.scratch_size, read.rms_error, read.max_error)

    @property
    def levels(self):
        """All levels of the image, full resolution first: a tuple of Level."""
        return tuple(self.level(level) for level in range(self._level(0).coarsest_level + 1))

    @property
    def box(self):
        """A Box that holds the image at all its levels; None if the file does not tell one."""
        box = _Box()
        _check(_lib.gim_read_box(*self._file._arguments, self._index, ctypes.addressof(box)))
        return _told_box(box)

    @property
    def planes(self):
        """The names of the attribute planes that the file has, of "normals", "colors", "displacements"."""
        return tuple(name for name in _PLANES if self._has_plane(name))

    def _has_plane(self, name):
        try:
            self._plane(name, 0)
        except Error as error:
            if error.status == NO_SUCH_PLANE:
                return False
            if error.status != NEED_MORE_INPUT:
                raise
        return True

    def plane_levels(self, name):
        """All levels of a plane, full resolution first: a tuple of Plane."""
        levels, level, last = [], 0, 0
        while level <= last:
            read = self._plane(name, level)
            last = read.coarsest_level
            levels.append(Plane(level, read.height, read.width, read.quantizer, read.prefix_size, read.scratch_size))
            level += 1
        return tuple(levels)

    def positions(self, level=0, out=None):
        """Decodes the geometry image: height x width x 3 float32, x y z in object units, NaN where no surface
        is. Samples of one point of the surface are equal. Values are relative to info.origin if info.is_relative.
        out: an array of that shape to write into; else a new one is made."""
        budget, read = _Budget(self._file._limits), self._level(level)
        positions = _output(out, (read.height, read.width, 3), budget)
        self._decode(_lib.gim_decode_positions, level, budget, read.scratch_size, _address(positions))
        return positions

    def mesh(self, level=0, normals=False, texcoords=False, split_sharp=False):
        """Decodes a triangle mesh that is closed where the surface is: a Mesh.
        split_sharp: vertices on sharp edges are split, so that normals on both sides are right; layout "tiles" only."""
        budget, read = _Budget(self._file._limits), self._level(level)
        if split_sharp:
            return self._split_mesh(read, level, normals, texcoords, budget)
        mesh = _empty_mesh(read.vertex_count, read.triangle_count, normals, texcoords, budget)
        self._decode_mesh(level, read, mesh, budget)
        return mesh

    def _decode_mesh(self, level, read, mesh, budget):
        self._decode(_lib.gim_decode_mesh, level, budget, read.scratch_size, _address(mesh.vertices),
                     _address(mesh.normals), _address(mesh.texcoords), _address(mesh.faces))

    def _split_mesh(self, read, level, normals, texcoords, budget):
        # The number of vertices is known only afterwards; arrays have room for the most there can be.
        mesh, count = _empty_mesh(read.width * read.height, read.triangle_count, normals, texcoords, budget), _u32()
        self._decode(_lib.gim_decode_hard_mesh, level, budget, read.scratch_size, ctypes.addressof(count),
                     _address(mesh.vertices), _address(mesh.normals), _address(mesh.texcoords), _address(mesh.faces))
        used = slice(count.value)
        return Mesh(mesh.vertices[used], mesh.faces, mesh.normals[used] if normals else None,
                    mesh.texcoords[used] if texcoords else None)

    def grid(self, level=0, normals=False, texcoords=False, faces=False, out=None):
        """Decodes the geometry image with what texturing needs: a Grid. out: an array for the positions."""
        budget, read = _Budget(self._file._limits), self._level(level)
        shape = (read.height, read.width)
        grid = Grid(_output(out, shape + (3,), budget), budget.array(shape + (3,)) if normals else None,
                    budget.array(shape + (2,)) if texcoords else None,
                    budget.array((read.triangle_count, 3), np.uint32) if faces else None)
        self._decode(_lib.gim_decode_grid, level, budget, read.scratch_size, *map(_address, grid))
        return grid

    def plane(self, name, level=0, out=None):
        """Decodes an attribute plane: height x width x 3 float32, at a resolution of its own.
        name: "normals" (unit length, out of the surface), "colors" (red green blue in 0..1, sRGB) or "displacements"
        (to be added to the surface, object units). Raises gim.Error with gim.NO_SUCH_PLANE if the file has none."""
        budget, read = _Budget(self._file._limits), self._plane(name, level)
        values = _output(out, (read.height, read.width, 3), budget)
        decode = lambda *a: _lib.gim_decode_plane(*a[:4], _plane_kind(name), *a[4:])
        self._decode(decode, level, budget, read.scratch_size, _address(values))
        return values

    def labels(self, level=0):
        """Decodes the label of each cell, for example its material: uint8, one for every two faces of mesh(level) or
        grid(level, faces=True). Raises gim.Error with gim.NO_SUCH_PLANE if the file has none."""
        budget, read = _Budget(self._file._limits), _LabelsInfo()
        _check(_lib.gim_read_labels_info(*self._file._arguments, self._index, _number(level), ctypes.byref(read)))
        labels = budget.array((read.cell_count,), np.uint8)
        self._decode(_lib.gim_decode_labels, level, budget, read.scratch_size, _address(labels))
        return labels


class File:
    """A .gim file. info: an Info. images: a tuple of Image, in layout "gim" one for each component of the surface.
    The bytes that it was opened with must not change while it is used; they are not copied."""

    def __init__(self, data, limits=None):
        self._limits = _checked(limits)
        view = memoryview(data)  # keeps what lends the bytes from moving them
        self._data = np.frombuffer(view, np.uint8) if view.nbytes else np.zeros(0, np.uint8)
        self._read = _Info()
        of_file = _Limits(*self._limits[:3])
        status = _lib.gim_read_info(_address(self._data), self._data.nbytes, ctypes.byref(of_file),
                                    ctypes.byref(self._read))
        _check(status)
        self._arguments = (ctypes.addressof(self._read), _address(self._data), self._data.nbytes)

    def __reduce__(self):  # addresses mean nothing in another process, or in a copy
        return File, (self._data.tobytes(), self._limits)

    @property
    def info(self):
        r = self._read
        return Info(r.version, _LAYOUTS[r.layout], _CODINGS[r.coding], r.bits, r.image_count, r.level_count,
                    r.sample_count, r.file_size, tuple(r.origin), bool(r.is_relative), r.step, r.quantizer,
                    r.index_size, tuple(r.level_rms_error[:r.level_count]), tuple(r.level_max_error[:r.level_count]),
                    _told_box(r.box) if r.has_boxes else None)

    @property
    def images(self):
        return tuple(Image(self, index) for index in range(self._read.image_count))

    @property
    def levels(self):
        """All levels of the file, full resolution first: a tuple of Level. Images that are too small for a level are
        left out of it."""
        return tuple(self._sum_of_level(level) for level in range(self._read.level_count))

    def choose_level(self, distance, vertical_fov, viewport_height, pixel_error=1, shown=None):
        """The level to show to a camera: the coarsest one whose largest error is at most pixel_error on the screen.
        distance: from the eye to the surface or its box, object units. vertical_fov: radians. viewport_height: pixels.
        shown: the level shown before; a coarser one replaces it only with some margin. None: none was shown."""
        view = _View(distance, vertical_fov, viewport_height, pixel_error)
        return _lib.gim_choose_level(ctypes.addressof(self._read), ctypes.addressof(view),
                                     _NO_LEVEL if shown is None else shown)

    def _sum_of_level(self, level):
        parts = [read for _, read in self._parts(level)]
        one = parts[0] if self._read.image_count == 1 else None
        return Level(level, one.height if one else None, one.width if one else None,
                     sum(p.vertex_count for p in parts), sum(p.triangle_count for p in parts),
                     max(p.prefix_size for p in parts), max(p.scratch_size for p in parts),
                     parts[0].rms_error, parts[0].max_error)

    def _parts(self, level):
        """The images that have the level, with its gim_level_info."""
        parts = []
        for image in self.images:
            try:
                parts.append((image, image._level(level)))
            except Error as error:
                if error.status != NO_SUCH_LEVEL:
                    raise
        if not parts:
            raise Error(NO_SUCH_LEVEL)
        return parts

    def _only(self):
        if self._read.image_count != 1:
            raise Error(BAD_ARGUMENT, f"the file holds {self._read.image_count} images: choose one of File.images")
        return Image(self, 0)

    @property
    def planes(self):
        """As Image.planes; the same for all images."""
        return Image(self, 0).planes

    def mesh(self, level=0, normals=False, texcoords=False, split_sharp=False):
        """Decodes the whole surface, all images in one Mesh. Otherwise as Image.mesh. Files of several images have no
        sharp edges to split."""
        if self._read.image_count == 1:
            return Image(self, 0).mesh(level, normals, texcoords, split_sharp)
        budget, parts = _Budget(self._limits), self._parts(level)
        whole = _empty_mesh(sum(read.vertex_count for _, read in parts), sum(read.triangle_count for _, read in parts),
                            normals, texcoords, budget)
        vertex = face = 0
        for image, read in parts:
            of_vertices, of_faces = slice(vertex, vertex + read.vertex_count), slice(face, face + read.triangle_count)
            part = Mesh(whole.vertices[of_vertices], whole.faces[of_faces],
                        whole.normals[of_vertices] if normals else None,
                        whole.texcoords[of_vertices] if texcoords else None)
            image._decode_mesh(level, read, part, _Budget(self._limits._replace(max_memory=budget.left)))
            part.faces[...] += np.uint32(vertex)
            vertex, face = of_vertices.stop, of_faces.stop
        return whole

    def positions(self, level=0, out=None):
        """As Image.positions, of the only image."""
        return self._only().positions(level, out)

    def grid(self, level=0, normals=False, texcoords=False, faces=False, out=None):
        """As Image.grid, of the only image."""
        return self._only().grid(level, normals, texcoords, faces, out)

    def plane(self, name, level=0, out=None):
        """As Image.plane, of the only image."""
        return self._only().plane(name, level, out)

    def array(self):
        """The image that gim.encode_image or `gim encode` imported: the array with its shape and type, and its mask as
        bool, height x width. A mask that was a channel is in the array too. Undefined samples are NaN if they were, else 0.
        Whole numbers are exact if the file is lossless. Raises gim.Error with gim.NO_SUCH_PLANE for other files."""
        read, budget = _RasterInfo(), _Budget(self._limits)
        _check(_lib.gim_read_raster_info(*self._arguments, ctypes.addressof(read)))
        numbers = budget.array((read.height, read.width, read.channels), np.int32)
        mask, scratch = budget.array((read.height, read.width), np.uint8), _Scratch(budget)
        scratch.reserve(read.scratch_size)
        _check(_lib.gim_decode_raster(*self._arguments, _address(numbers), _address(mask), scratch.address,
                                      scratch.size))
        mask, kind = mask.astype(bool), np.dtype(_SAMPLE_TYPES[read.sample_type])
        values = np.where(mask[..., None], self._raster_values(numbers, budget), 0)
        if kind.kind != "f":
            values = np.clip(np.rint(values), np.iinfo(kind).min, np.iinfo(kind).max)
        elif read.mask == 0:
            values[~mask] = np.nan
        values = values.astype(kind)
        if read.mask >= 2:
            of_mask = np.where(mask, read.mask_value, 0).astype(kind)
            values = np.insert(values, read.mask - 2, of_mask, axis=2)
        return (values.transpose(2, 0, 1) if read.is_channels_first else values), mask

    def _raster_values(self, numbers, budget):
        values = budget.array(numbers.shape, np.float64)
        for k in range(numbers.shape[2]):
            channel = _RasterChannel()
            _check(_lib.gim_read_raster_channel(*self._arguments, k, ctypes.addressof(channel)))
            values[..., k] = channel.origin + channel.step * numbers[..., k]
        return values

    @property
    def text(self):
        """The text that the file carries about itself; "" if none."""
        size, budget = _u64(), _Budget(self._limits)
        _check(_lib.gim_read_text(*self._arguments, None, 0, ctypes.addressof(size), None, 0))
        if size.value == 0:
            return ""
        text, scratch = budget.array(size.value, np.uint8), _Scratch(budget)
        scratch.reserve(_lib.gim_text_scratch_size())
        _check(_lib.gim_read_text(*self._arguments, _address(text), size.value, ctypes.addressof(size), scratch.address,
                                  scratch.size))
        return text.tobytes().decode("utf-8", "replace")


def _number(level):
    level = operator.index(level)
    if not 0 <= level < 2 ** 32:
        raise Error(NO_SUCH_LEVEL)
    return level


def _plane_kind(name):
    if name not in _PLANES:
        raise ValueError(f"a plane is one of {', '.join(_PLANES)}, not {name!r}")
    return _PLANES.index(name)


def _empty_mesh(vertex_count, face_count, normals, texcoords, budget):
    return Mesh(budget.array((vertex_count, 3)), budget.array((face_count, 3), np.uint32),
                budget.array((vertex_count, 3)) if normals else None,
                budget.array((vertex_count, 2)) if texcoords else None)


_open_file = open


def open(source, limits=None):
    """Opens a .gim file: a File.
    source  a path (str or PathLike), which is read whole; or the bytes, as anything with the buffer protocol: bytes,
            bytearray, memoryview, mmap, a contiguous numpy array. These are not copied. A prefix of a file will do, for
            the levels that it holds.
    limits  Limits that this file and every later call on it must keep
    Cost: the index of the file."""
    if isinstance(source, File):
        return source
    if isinstance(source, (str, os.PathLike)):
        source = _read_file(source, _checked(limits))
    return File(source, limits)


# ---- batches ---------------------------------------------------------------------------------------------------------

class Frames(NamedTuple):
    """Where the numbers of a batch lie: position = offset + scale * value, in float64.
    offset: n x 3 float64. scale: n float64."""
    offset: np.ndarray
    scale: np.ndarray


_BATCH_TYPES = (np.dtype(np.float32), np.dtype(np.float16), np.dtype(np.uint16))


def decode_batch(items, level=0, dtype=np.float32, layout="HWC", channels="xyz", threads=1, out=None, frames=False,
                 limits=None):
    """Decodes the geometry images of several files into one array.

    items     a sequence of what gim.open takes, of File or of Image. All must have one image, and as many rows and
              columns at this level as the first
    dtype     float32: object units, the bits of Image.positions. float16: the middle of an item's bounding box is 0,
              its longest side reaches from -1 to 1. uint16: its lower corner is 0, the longest side reaches to 65535
    layout    "HWC": n x height x width x channels. "CHW": n x channels x height x width
    channels  "xyz". "xyzm": a fourth channel is 1 (uint16: 65535) on the surface and 0 elsewhere. Where no surface is,
              x y z are 0 with "xyzm" and with uint16, else NaN
    threads   how many decode at the same time; 0: as many as there are cores. The array does not depend on it
    out       an array of that shape and type to write into; else a new one is made
    frames    True: returns (array, Frames), which turn the numbers into positions, the origin of the file included
    limits    Limits of each file. max_memory holds for the whole call: results, scratch and files that are read

    Raises gim.Error, of the first item in the list that failed if threads is 1; then `out` is unspecified."""
    items, dtype = list(items), np.dtype(dtype)
    if not items:
        raise ValueError("decode_batch needs at least one item")
    if dtype not in _BATCH_TYPES:
        raise ValueError("dtype must be float32, float16 or uint16")
    if layout not in ("HWC", "CHW") or channels not in ("xyz", "xyzm"):
        raise ValueError('layout must be "HWC" or "CHW", channels "xyz" or "xyzm"')
    if threads < 0:
        raise ValueError("threads must not be negative")
    batch = _Batch(items, _number(level), _checked(limits))
    grid = batch.shape_of_first()
    shape = grid + (len(channels),) if layout == "HWC" else (len(channels),) + grid
    batch.aim(grid, _output(out, (len(items),) + shape, batch.budget, dtype), layout, channels)
    batch.run(min(threads or os.cpu_count() or 1, len(items)))
    return (batch.out, batch.frames) if frames else batch.out


class _SharedBudget(_Budget):
    """A _Budget that threads share, and that takes memory back."""

    def __init__(self, limits):
        super().__init__(limits)
        self._lock = threading.Lock()

    def take(self, size):
        with self._lock:
            super().take(size)


class _Batch:
    """One call of decode_batch. Its threads take the next item until none is left."""

    def __init__(self, items, level, limits):
        self.items, self.level, self.limits, self.budget = items, level, limits, _SharedBudget(limits)
        self.frames = Frames(np.zeros((len(items), 3)), np.ones(len(items)))
        self.next, self.failed = iter(range(len(items))), False

    def shape_of_first(self):
        with self._image(0) as image:
            read = image._level(self.level)
        return read.height, read.width

    def aim(self, grid, out, layout, channels):
        self.grid, self.out, self.has_mask, self.is_chw = grid, out, channels == "xyzm", layout == "CHW"
        self.is_direct = out.dtype == np.float32 and not self.has_mask and not self.is_chw

    def run(self, threads):
        if threads == 1:
            self._work()
            return
        with ThreadPoolExecutor(threads) as pool:
            try:
                for done in [pool.submit(self._work) for _ in range(threads)]:
                    done.result()
            except BaseException:
                self.failed = True
                raise

    @contextlib.contextmanager
    def _image(self, index):
        """The image of an item, and its memory as long as it is used. Errors tell the item."""
        item, size = self.items[index], 0
        try:
            if isinstance(item, (str, os.PathLike)):
                size = os.stat(item).st_size
                self.budget.take(size)
                item = _read_file(item, self.limits if self.limits.max_memory is None else
                                  self.limits._replace(max_memory=size))
            yield item if isinstance(item, Image) else open(item, self.limits)._only()
        except Error as error:
            raise Error(error.status, error.reason, index) from None
        self.budget.take(-size)

    def _work(self):
        scratch = _Scratch(self.budget)
        try:
            # Files decode into this, and into the result from here, if the result has another form.
            staging = None
            if not self.is_direct:
                staging = self.budget.array(self.grid + (3,))
                self.budget.take(self.grid[0] * self.grid[1])  # which samples are undefined
            for index in self.next:
                if self.failed:
                    return
                with self._image(index) as image:
                    self._decode(index, image, scratch, self.out[index] if staging is None else staging)
        except BaseException:
            self.failed = True
            raise

    def _decode(self, index, image, scratch, positions):
        read = image._level(self.level)
        if (read.height, read.width) != self.grid:
            raise Error(BAD_ARGUMENT, f"has {read.height} x {read.width} samples at level {self.level}, the first item "
                                      f"has {self.grid[0]} x {self.grid[1]}")
        scratch.reserve(read.scratch_size)
        _check(_lib.gim_decode_positions(*image._file._arguments, image._index, self.level, _address(positions),
                                         scratch.address, scratch.size))
        if not self.is_direct:
            self._convert(index, positions, may_be_undefined=image._file._read.layout != 0)
        if image._file._read.is_relative:
            self.frames.offset[index] += image._file._read.origin

    def _convert(self, index, positions, may_be_undefined):
        target = self.out[index]
        planes = target if self.is_chw else np.moveaxis(target, -1, 0)  # three or four views of height x width
        undefined = np.isnan(positions[..., 0]) if may_be_undefined else None
        if self.out.dtype != np.float32:
            self._put_into_frame(index, positions, may_be_undefined)
        if undefined is not None and (self.has_mask or self.out.dtype == np.uint16):
            positions[undefined] = 0
        for axis in range(3):
            np.copyto(planes[axis], positions[..., axis], casting="unsafe")
        if self.has_mask:
            planes[3] = 65535 if self.out.dtype == np.uint16 else 1
            if undefined is not None:
                planes[3][undefined] = 0

    def _put_into_frame(self, index, positions, may_be_undefined):
        """Turns positions into numbers of the item's frame, and keeps the frame."""
        rows = positions.reshape(self.grid[0], -1)  # along rows, x y z after each other: quicker than columns of 3
        low, high = ((np.fmin, np.fmax) if may_be_undefined else (np.minimum, np.maximum))
        lower = low.reduce(low.reduce(rows, 0).reshape(-1, 3), 0)
        upper = high.reduce(high.reduce(rows, 0).reshape(-1, 3), 0)
        side = float(np.max(upper.astype(np.float64) - lower)) or 1.0
        if self.out.dtype == np.uint16:
            offset, scale = lower, side / 65535
        else:
            offset, scale = ((lower.astype(np.float64) + upper) / 2).astype(np.float32), side / 2
        np.subtract(rows, np.tile(offset, self.grid[1]), out=rows)
        np.multiply(rows, np.float32(1 / scale), out=rows)
        if self.out.dtype == np.uint16:
            np.add(rows, np.float32(0.5), out=rows)  # casting cuts off
        self.frames.offset[index], self.frames.scale[index] = offset, scale


# ---- encoding --------------------------------------------------------------------------------------------------------

def encode(vertices, faces, *, vertex_normals=None, vertex_colors=None, program=None, timeout=None, **options):
    """Encodes a triangle mesh by the program `gim encode`: the bytes of a .gim file.

    vertices   n x 3 numbers; the program gets float32 as it is and others as float64
    faces      m x 3 whole numbers, counter-clockwise seen from outside; m x 4 for quads
    vertex_normals  n x 3 numbers: they tell which edges are hard
    vertex_colors   n x 3 uint8: red, green, blue
    program    the program; else GIM_PROGRAM names it, else it is looked for in PATH
    timeout    seconds, then subprocess.TimeoutExpired is raised
    options    those of `gim encode --help` with _ for -: psnr=70, size=257, layout="tiles", max_error="0.3%",
               lossless=True, normals=512 (the side of a normal map). None and False leave an option out

    The mesh goes to the program through a pipe; no file is written. What the program warns of comes as UserWarning. If
    it fails, gim.Error has its message and its exit_status."""
    return _run_encode("ply", _ply(vertices, faces, vertex_normals, vertex_colors), program, timeout, options)


def encode_image(array, mask=None, *, refit=None, program=None, timeout=None, **options):
    """Encodes a multi-chart image that another program made, sample by sample: the bytes of a .gim file.

    array    height x width x channels, or channels first: x, y, z, then perhaps a mask, and others; float16, float32,
             float64, and whole numbers of 8, 16 and 32 bits
    mask     height x width; not 0 where a sample is defined. None: where the array is NaN, a sample is undefined; without
             NaN, channel 3 is the mask if there is one
    refit    the mesh that the image shows: the name of a file, or (vertices, faces). Samples are fitted to it, and psnr and
             max_error count against it. None: samples stay where they are
    options  those of `gim encode --help` that images have, as for gim.encode: lossless=True, bits=16, psnr=70, bytes=4000,
             mask_channel=4 or "none", channels="first"

    File.array gives the image back. The rest is as in gim.encode."""
    arrays, file = {"image": np.asarray(array)}, io.BytesIO()
    if mask is not None:
        arrays["mask"] = np.asarray(mask)
    np.savez(file, **arrays)
    if refit is None:
        return _run_encode("npz", file.getvalue(), program, timeout, options)
    if isinstance(refit, (str, os.PathLike)):
        return _run_encode("npz", file.getvalue(), program, timeout, {**options, "refit": os.fspath(refit)})
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "refit.ply")
        with io.open(name, "wb") as out:
            out.write(_ply(*refit, None, None))
        return _run_encode("npz", file.getvalue(), program, timeout, {**options, "refit": name})


def _run_encode(kind, data, program, timeout, options):
    command = [_find_program(program), "encode", "-", "-", "--format=" + kind, "--quiet"]
    command += [word for name, value in options.items() for word in _option(name, value)]
    run = subprocess.run(command, input=data, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=timeout, check=False)
    message = run.stderr.decode("utf-8", "replace").strip()
    if run.returncode != 0:
        raise Error(None, message or f"gim encode ended with status {run.returncode}", exit_status=run.returncode)
    if message:
        warnings.warn(message, stacklevel=3)
    return run.stdout


def _find_program(program):
    program = program or os.environ.get("GIM_PROGRAM") or shutil.which("gim")
    if not program:
        raise FileNotFoundError("gim.encode needs the program gim: put it into PATH, or let the environment variable "
                                "GIM_PROGRAM name it")
    return os.fspath(program)


def _option(name, value):
    if not re.fullmatch("[a-z]+(_[a-z]+)*", name) or name in ("format", "quiet", "help"):
        raise TypeError(f"gim.encode has no option {name!r}")
    if value is None or value is False:
        return []
    word = "--" + name.replace("_", "-")
    return [word if value is True else f"{word}={value}"]


def _rows(name, values, columns, dtype, count=None):
    array = np.ascontiguousarray(values, dtype)
    if array.ndim != 2 or array.shape[1] not in columns or (count is not None and len(array) != count):
        raise ValueError(f"{name} must be an array of {count or 'n'} x {' or '.join(map(str, columns))} numbers")
    return array


def _ply(vertices, faces, normals, colors):
    """The mesh as a binary PLY file."""
    vertices = np.asarray(vertices)
    kind = "<f4" if vertices.dtype.kind == "f" and vertices.dtype.itemsize < 8 else "<f8"
    vertices = _rows("vertices", vertices, (3,), kind)
    faces = np.asarray(faces)
    if faces.size and (faces.dtype.kind not in "iu" or faces.min() < 0 or faces.max() >= min(len(vertices), 2 ** 31)):
        raise ValueError("faces must be whole numbers from 0 to the number of vertices - 1")
    faces = _rows("faces", faces, (3, 4), "<i4")
    fields, values = [("position", kind, 3)], [vertices]
    word = "double" if kind == "<f8" else "float"
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property {word} {axis}" for axis in "xyz"]
    if normals is not None:
        fields.append(("normal", "<f4", 3))
        values.append(_rows("vertex_normals", normals, (3,), "<f4", len(vertices)))
        header += [f"property float n{axis}" for axis in "xyz"]
    if colors is not None:
        colors = np.asarray(colors)
        if colors.dtype != np.uint8:
            raise ValueError("vertex_colors must be uint8")
        fields.append(("color", "u1", 3))
        values.append(_rows("vertex_colors", colors, (3,), "u1", len(vertices)))
        header += [f"property uchar {name}" for name in ("red", "green", "blue")]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    rows = np.empty(len(vertices), fields)
    for (name, _, _), column in zip(fields, values):
        rows[name] = column
    lists = np.empty(len(faces), [("count", "u1"), ("corners", "<i4", faces.shape[1])])
    lists["count"], lists["corners"] = faces.shape[1], faces
    return b"".join(["\n".join(header).encode(), rows.tobytes(), lists.tobytes()])
