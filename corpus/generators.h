// Generators of test meshes. Sizes are numbers of cells along an edge or around. Every mesh has about unit size and
// faces outwards.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gim/encoder.h"

namespace gim::corpus {

using Point = std::array<double, 3>;

// Cube of n x n squares a side, projected on the sphere: 12 n^2 triangles.
TriangleMesh sphere(uint32_t n);
// The same cube with its sharp edges, stretched to 1 x size_y x size_z.
TriangleMesh box(uint32_t n, double size_y, double size_z);
// `holes` (1..6) square openings in the middles of the cube's sides, each a third of the side wide; n divisible by 3.
TriangleMesh sphere_with_holes(uint32_t n, uint32_t holes);
// 2 * around * across triangles.
TriangleMesh torus(uint32_t around, uint32_t across, double radius, double tube_radius);
// A flat sharp-edged plate with a row of square holes: a CAD part of genus `holes`. `cells` per hole side.
TriangleMesh plate_with_holes(uint32_t holes, uint32_t cells);
TriangleMesh disk(uint32_t rings, uint32_t sectors);
TriangleMesh annulus(uint32_t rings, uint32_t sectors, double inner_radius);
TriangleMesh open_cylinder(uint32_t rows, uint32_t sectors, double height);
// (n+1)^2 vertices of a smooth height field, one boundary.
TriangleMesh terrain(uint32_t n);
// A body with five long limbs, of genus 0. `cells` along the longest side of its box.
TriangleMesh limbed_blob(uint32_t cells);
// A ring of `holes` tori melted together, genus `holes`.
TriangleMesh melted_tori(uint32_t holes, uint32_t cells);
// The closed surface where `inside` changes sign, by marching tetrahedra in a box around the origin. Positive is
// inside.
TriangleMesh isosurface(const std::function<double(const Point&)>& inside, const Point& half_size, uint32_t cells);

// Displaces every vertex along its normal by up to `amplitude`: a hash of its index says how far.
TriangleMesh roughened(TriangleMesh mesh, double amplitude, uint64_t seed);
// Cuts each triangle into parts * parts, on a surface that is round where vertex normals differ: Boubekeur, Alexa. Phong
// Tessellation. SIGGRAPH Asia 2008. Makes dense scans of sparse ones; parts >= 1.
TriangleMesh densified(const TriangleMesh& mesh, uint32_t parts);
// Each triangle with its own three vertices.
TriangleMesh soup(const TriangleMesh& mesh);
// Several meshes in one, the k-th shifted along x by k * step.
TriangleMesh together(const std::vector<TriangleMesh>& meshes, double step);

// Broken on purpose.
TriangleMesh edge_with_three_faces();
TriangleMesh bow_tie();  // two closed tetrahedra that share one vertex
TriangleMesh moebius_strip(uint32_t sectors);

}  // namespace gim::corpus
