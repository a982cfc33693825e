#!/bin/sh
# Uses what the packages install: the program, Python, C and C++ programs. Runs where they are installed, without the source.
# Usage: try.sh FOLDER      with main.c and main.cpp of tests/consumer
set -eu
unset GIM_LIBRARY GIM_PROGRAM
consumer=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

echo "-- the program"
awk 'BEGIN {  # a torus
    rows = 24; columns = 16; turn = 6.283185307179586
    print "ply\nformat ascii 1.0\nelement vertex " rows * columns
    print "property float x\nproperty float y\nproperty float z\nelement face " rows * columns
    print "property list uchar int vertex_indices\nend_header"
    for (i = 0; i < rows; ++i) for (j = 0; j < columns; ++j) {
        u = i * turn / rows; v = j * turn / columns
        print (2 + cos(v)) * cos(u), (2 + cos(v)) * sin(u), sin(v)
    }
    for (i = 0; i < rows; ++i) for (j = 0; j < columns; ++j) {
        below = (i + 1) % rows; right = (j + 1) % columns
        print 4, i * columns + j, below * columns + j, below * columns + right, i * columns + right
    }
}' >torus.ply
gim --version
gim encode torus.ply torus.gim --size 65 --quiet
gim info torus.gim >/dev/null
gim decode torus.gim torus-decoded.ply
gim compare torus.ply torus.gim | grep -E "^(test|Hausdorff|PSNR)"
test -s "${SHARE:-/usr/share}/man/man1/gim-encode.1.gz"

echo "-- Python"
/usr/bin/python3 - <<'PYTHON'
import gim

surface = gim.open("torus.gim")
mesh = surface.mesh(0)
header = open("torus-decoded.ply", "rb").read().split(b"end_header")[0]
assert b"element vertex %d\n" % len(mesh.vertices) in header, header
assert surface.positions(1).shape == (33, 33, 3)
again = gim.open(gim.encode(mesh.vertices, mesh.faces, size=33))
print(again.info.file_size, "bytes,", again.levels[0].vertex_count, "vertices")
PYTHON

echo "-- C and C++ programs, with the shared and with the static library"
flags=$(pkg-config --cflags --libs gim-decoder)
cc "$consumer/main.c" -o shared $flags
ldd shared | grep -q libgim-decoder.so.0
./shared torus.gim
c++ -std=c++20 "$consumer/main.cpp" -o shared-cpp $flags
./shared-cpp torus.gim
flags=$(pkg-config --cflags --libs --static gim-decoder | sed s/-lgim-decoder/-l:libgim-decoder.a/)
cc "$consumer/main.c" -o static $flags
./static torus.gim
echo "-- all of it works"
