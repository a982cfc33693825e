// gim_lindstrom_turk: simplifies a mesh with CGAL's edge collapse, Lindstrom-Turk cost and placement. It is the
// strongest simplifier that gim is measured against.
//
// EVALUATION ONLY. CGAL's package Surface_mesh_simplification is GPL-3.0-or-later (or commercial), so a built copy of
// this program is under the GPL as a whole. It is built only with GIM_BUILD_RD and an installed CGAL, as a program of
// its own. It is never installed, nothing of gim links it, and no file of CGAL is in this repository.
//
// In: a mesh, and ratios of its edges to keep. Out: one PREFIX<ratio>.off for each. The method is memoryless (it
// compares with the current surface, not with the input), so every ratio continues from the one before.
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "tools/file.h"
#include "tools/input.h"

namespace {

using Surface = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

int fail(const std::string& file, const std::string& message) {
    std::fprintf(stderr, "gim_lindstrom_turk: %s: %s\n", file.c_str(), message.c_str());
    return 1;
}

// If the input is not an oriented manifold, splits vertices until it is.
Surface as_surface(const gim::TriangleMesh& mesh) {
    std::vector<Surface::Point> points;
    for (const auto& p : mesh.positions) points.emplace_back(p[0], p[1], p[2]);
    std::vector<std::vector<size_t>> polygons;
    for (const auto& t : mesh.triangles) {
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) polygons.push_back({t[0], t[1], t[2]});
    }
    namespace Processing = CGAL::Polygon_mesh_processing;
    if (!Processing::is_polygon_soup_a_polygon_mesh(polygons)) Processing::orient_polygon_soup(points, polygons);
    Surface surface;
    Processing::polygon_soup_to_polygon_mesh(points, polygons, surface);
    return surface;
}

void simplify(Surface& surface, size_t edges) {
    namespace Simplification = CGAL::Surface_mesh_simplification;
    Simplification::edge_collapse(surface, Simplification::Count_stop_predicate<Surface>(edges),
                                  CGAL::parameters::get_cost(Simplification::LindstromTurk_cost<Surface>())
                                      .get_placement(Simplification::LindstromTurk_placement<Surface>()));
}

// Whole or not at all: run.py takes a file that is there for complete.
gim::Result<void> write_off(const std::string& path, Surface surface) {
    surface.collect_garbage();
    std::string text = "OFF\n" + std::to_string(surface.number_of_vertices()) + ' ' +
                       std::to_string(surface.number_of_faces()) + " 0\n";
    for (const auto v : surface.vertices()) {
        const Surface::Point& p = surface.point(v);
        char line[80];
        std::snprintf(line, sizeof(line), "%.9g %.9g %.9g\n", p.x(), p.y(), p.z());
        text += line;
    }
    for (const auto f : surface.faces()) {
        text += '3';
        for (const auto v : vertices_around_face(surface.halfedge(f), surface)) {
            text += ' ' + std::to_string(static_cast<size_t>(v));
        }
        text += '\n';
    }
    return gim::write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fputs("usage: gim_lindstrom_turk IN PREFIX RATIO...   (writes PREFIX<ratio>.off)\n", stderr);
        return 2;
    }
    const std::string input = argv[1], prefix = argv[2];
    std::vector<double> ratios;
    for (int i = 3; i < argc; ++i) {
        char* end = nullptr;
        ratios.push_back(std::strtod(argv[i], &end));
        if (*end != '\0' || !(ratios.back() > 0 && ratios.back() <= 1)) {
            std::fprintf(stderr, "gim_lindstrom_turk: %s is not a ratio in (0, 1]\n", argv[i]);
            return 2;
        }
    }
    std::sort(ratios.begin(), ratios.end(), std::greater<>());

    const gim::Result<gim::TriangleMesh> read = gim::read_surface(input, 0);
    if (!read.ok()) return fail(input, read.error().message);
    Surface surface = as_surface(gim::weld_equal_positions(read.value()));
    if (surface.is_empty()) return fail(input, "it has no triangles");
    const auto edges = static_cast<double>(surface.number_of_edges());
    for (const double ratio : ratios) {
        simplify(surface, static_cast<size_t>(ratio * edges));
        char name[32];
        std::snprintf(name, sizeof(name), "%g.off", ratio);
        const gim::Result<void> written = write_off(prefix + name, surface);
        if (!written.ok()) return fail(prefix + name, written.error().message);
    }
    return 0;
}
