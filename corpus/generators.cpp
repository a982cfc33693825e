// Generators of test meshes (generators.h).
#include "corpus/generators.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace gim::corpus {

namespace {

using std::numbers::pi;

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double norm(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

void add_quad(TriangleMesh& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
}

// Gives lattice points their vertex numbers as they are first used.
class Lattice {
  public:
    uint32_t vertex(const std::array<int, 3>& at) {
        const auto [entry, is_new] = index_.try_emplace(at, static_cast<uint32_t>(order_.size()));
        if (is_new) order_.push_back(at);
        return entry->second;
    }
    const std::vector<std::array<int, 3>>& points() const { return order_; }

  private:
    std::map<std::array<int, 3>, uint32_t> index_;
    std::vector<std::array<int, 3>> order_;
};

// The surface of the cube [0, n]^3 in unit squares, without those that `is_open(side, row, column)` names; sides 0..5.
template <class IsOpen>
TriangleMesh cube_surface(int n, const IsOpen& is_open) {
    TriangleMesh mesh;
    Lattice lattice;
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const bool high = side % 2 == 1;
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                if (is_open(side, i, j)) continue;
                const auto corner = [&](int di, int dj) {
                    std::array<int, 3> at{};
                    at[axis] = high ? n : 0;
                    at[u] = i + di;
                    at[v] = j + dj;
                    return lattice.vertex(at);
                };
                if (high) {
                    add_quad(mesh, corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
                } else {
                    add_quad(mesh, corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0));
                }
            }
        }
    }
    for (const auto& at : lattice.points()) {
        mesh.positions.push_back({2.0 * at[0] / n - 1, 2.0 * at[1] / n - 1, 2.0 * at[2] / n - 1});
    }
    return mesh;
}

// Maps the cube to the unit sphere and evens out the squares.
void inflate(TriangleMesh& mesh) {
    for (Point& p : mesh.positions) {
        for (double& x : p) x = std::tan(x * pi / 4);
        p = (1 / norm(p)) * p;
    }
}

// A grid of rows x sectors quads that closes around in the second direction.
TriangleMesh ring_grid(uint32_t rows, uint32_t sectors, const std::function<Point(double, double)>& at) {
    TriangleMesh mesh;
    for (uint32_t r = 0; r <= rows; ++r) {
        for (uint32_t s = 0; s < sectors; ++s) mesh.positions.push_back(at(double(r) / rows, 2 * pi * s / sectors));
    }
    for (uint32_t r = 0; r < rows; ++r) {
        for (uint32_t s = 0; s < sectors; ++s) {
            const uint32_t t = (s + 1) % sectors;
            add_quad(mesh, r * sectors + s, r * sectors + t, (r + 1) * sectors + t, (r + 1) * sectors + s);
        }
    }
    return mesh;
}

uint64_t mix(uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

// Depth inside a capsule around a segment; negative outside.
double capsule(const Point& p, const Point& a, const Point& b, double radius) {
    const Point ab = b - a;
    const double t = std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0);
    return radius - norm(p - a - t * ab);
}

double smooth_union(double a, double b, double width) {
    const double h = std::max(width - std::abs(a - b), 0.0) / width;
    return std::max(a, b) + 0.25 * h * h * width;
}

// Per vertex, of length 1; zero where no triangle with area is.
std::vector<Point> vertex_normals(const TriangleMesh& mesh) {
    std::vector<Point> normals(mesh.positions.size(), Point{0, 0, 0});
    for (const auto& t : mesh.triangles) {
        const Point& a = mesh.positions[t[0]];
        const Point normal = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
        for (const uint32_t v : t) normals[v] = normals[v] + normal;
    }
    for (Point& normal : normals) {
        const double length = norm(normal);
        if (length > 0) normal = (1 / length) * normal;
    }
    return normals;
}

class Densifier {
  public:
    Densifier(const TriangleMesh& mesh, uint32_t parts) : mesh_(mesh), parts_(parts), normals_(vertex_normals(mesh)) {
        result_.positions = mesh.positions;
        result_.triangles.reserve(mesh.triangles.size() * parts * parts);
        for (const auto& t : mesh.triangles) add(t);
    }
    TriangleMesh result() && { return std::move(result_); }

  private:
    using Face = std::array<uint32_t, 3>;

    void add(const Face& t) {
        // Vertices row by row: row 0 is t[0], the last row runs from t[1] to t[2].
        std::vector<std::vector<uint32_t>> rows(parts_ + 1);
        for (uint32_t i = 0; i <= parts_; ++i) {
            for (uint32_t j = 0; j <= i; ++j) rows[i].push_back(vertex(t, {parts_ - i, i - j, j}));
        }
        for (uint32_t i = 0; i < parts_; ++i) {
            for (uint32_t j = 0; j <= i; ++j) {
                result_.triangles.push_back({rows[i][j], rows[i + 1][j], rows[i + 1][j + 1]});
                if (j < i) result_.triangles.push_back({rows[i][j], rows[i + 1][j + 1], rows[i][j + 1]});
            }
        }
    }

    // weights: of the three corners; their sum is parts_.
    uint32_t vertex(const Face& t, const Face& weights) {
        for (size_t k = 0; k < 3; ++k) {
            const size_t a = (k + 1) % 3, b = (k + 2) % 3;
            if (weights[k] == parts_) return t[k];
            if (weights[k] == 0 && weights[a] > 0 && weights[b] > 0) return on_edge(t[a], t[b], weights[b]);
        }
        return new_vertex(t, weights);
    }

    // The vertex `weight` parts of the way from a to b. Both faces of an edge share it.
    uint32_t on_edge(uint32_t a, uint32_t b, uint32_t weight) {
        if (a > b) {
            std::swap(a, b);
            weight = parts_ - weight;
        }
        const auto [entry, is_new] = edges_.try_emplace(uint64_t{a} << 32 | b, 0);
        if (is_new) {
            entry->second = static_cast<uint32_t>(result_.positions.size());
            for (uint32_t k = 1; k < parts_; ++k) new_vertex({a, b, b}, {parts_ - k, k, 0});
        }
        return entry->second + weight - 1;
    }

    uint32_t new_vertex(const Face& t, const Face& weights) {
        constexpr double kRoundness = 0.75;
        Point flat{0, 0, 0}, round{0, 0, 0};
        for (size_t k = 0; k < 3; ++k) flat = flat + (double(weights[k]) / parts_) * mesh_.positions[t[k]];
        for (size_t k = 0; k < 3; ++k) {
            const Point& normal = normals_[t[k]];
            const Point on_plane = flat - dot(flat - mesh_.positions[t[k]], normal) * normal;
            round = round + (double(weights[k]) / parts_) * on_plane;
        }
        result_.positions.push_back((1 - kRoundness) * flat + kRoundness * round);
        return static_cast<uint32_t>(result_.positions.size() - 1);
    }

    const TriangleMesh& mesh_;
    uint32_t parts_;
    std::vector<Point> normals_;
    std::unordered_map<uint64_t, uint32_t> edges_;  // the first of the vertices inside each
    TriangleMesh result_;
};

}  // namespace

TriangleMesh sphere(uint32_t n) {
    TriangleMesh mesh = cube_surface(static_cast<int>(n), [](int, int, int) { return false; });
    inflate(mesh);
    return mesh;
}

TriangleMesh box(uint32_t n, double size_y, double size_z) {
    TriangleMesh mesh = cube_surface(static_cast<int>(n), [](int, int, int) { return false; });
    for (Point& p : mesh.positions) p = {p[0], p[1] * size_y, p[2] * size_z};
    return mesh;
}

TriangleMesh sphere_with_holes(uint32_t n, uint32_t holes) {
    const int third = static_cast<int>(n) / 3;
    TriangleMesh mesh = cube_surface(static_cast<int>(n), [&](int side, int i, int j) {
        return side < static_cast<int>(holes) && i / third == 1 && j / third == 1;
    });
    inflate(mesh);
    return mesh;
}

TriangleMesh torus(uint32_t around, uint32_t across, double radius, double tube_radius) {
    TriangleMesh mesh;
    for (uint32_t i = 0; i < around; ++i) {
        for (uint32_t j = 0; j < across; ++j) {
            const double u = 2 * pi * i / around, v = 2 * pi * j / across;
            const double from_axis = radius + tube_radius * std::cos(v);
            mesh.positions.push_back({from_axis * std::cos(u), from_axis * std::sin(u), tube_radius * std::sin(v)});
            const uint32_t i1 = (i + 1) % around, j1 = (j + 1) % across;
            add_quad(mesh, i * across + j, i1 * across + j, i1 * across + j1, i * across + j1);
        }
    }
    return mesh;
}

TriangleMesh plate_with_holes(uint32_t holes, uint32_t cells) {
    const int c = std::max(1, static_cast<int>(cells)), width = (2 * static_cast<int>(holes) + 1) * c, height = 3 * c,
              depth = c;
    const auto solid = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < width && y < height && !((x / c) % 2 == 1 && y / c == 1);
    };
    TriangleMesh mesh;
    Lattice lattice;
    const auto quad = [&](const std::array<int, 3>& a, const std::array<int, 3>& b, const std::array<int, 3>& d,
                          const std::array<int, 3>& e) {
        add_quad(mesh, lattice.vertex(a), lattice.vertex(b), lattice.vertex(d), lattice.vertex(e));
    };
    for (int x = 0; x < width; ++x) {
        for (int y = 0; y < height; ++y) {
            if (!solid(x, y)) continue;
            quad({x, y, depth}, {x + 1, y, depth}, {x + 1, y + 1, depth}, {x, y + 1, depth});
            quad({x, y, 0}, {x, y + 1, 0}, {x + 1, y + 1, 0}, {x + 1, y, 0});
            for (int z = 0; z < depth; ++z) {
                if (!solid(x + 1, y)) quad({x + 1, y, z}, {x + 1, y + 1, z}, {x + 1, y + 1, z + 1}, {x + 1, y, z + 1});
                if (!solid(x - 1, y)) quad({x, y, z}, {x, y, z + 1}, {x, y + 1, z + 1}, {x, y + 1, z});
                if (!solid(x, y + 1)) quad({x, y + 1, z}, {x, y + 1, z + 1}, {x + 1, y + 1, z + 1}, {x + 1, y + 1, z});
                if (!solid(x, y - 1)) quad({x, y, z}, {x + 1, y, z}, {x + 1, y, z + 1}, {x, y, z + 1});
            }
        }
    }
    const double scale = 2.0 / width;
    for (const auto& at : lattice.points()) {
        mesh.positions.push_back({scale * at[0] - 1, scale * (at[1] - 0.5 * height), scale * (at[2] - 0.5 * depth)});
    }
    return mesh;
}

TriangleMesh annulus(uint32_t rings, uint32_t sectors, double inner_radius) {
    // Rows from the outer circle inwards, so that the faces look along +z.
    return ring_grid(rings, sectors, [&](double row, double angle) -> Point {
        const double radius = 1 + row * (inner_radius - 1);
        return {radius * std::cos(angle), radius * std::sin(angle), 0.2 * radius * radius};
    });
}

TriangleMesh disk(uint32_t rings, uint32_t sectors) {
    TriangleMesh mesh = annulus(rings, sectors, 1.0 / (rings + 1));
    const auto middle = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back({0, 0, 0});
    for (uint32_t s = 0; s < sectors; ++s) {
        mesh.triangles.push_back({rings * sectors + s, rings * sectors + (s + 1) % sectors, middle});
    }
    return mesh;
}

TriangleMesh open_cylinder(uint32_t rows, uint32_t sectors, double height) {
    return ring_grid(rows, sectors, [&](double row, double angle) -> Point {
        return {0.5 * std::cos(angle), 0.5 * std::sin(angle), height * (row - 0.5)};
    });
}

TriangleMesh terrain(uint32_t n) {
    TriangleMesh mesh;
    for (uint32_t i = 0; i <= n; ++i) {
        for (uint32_t j = 0; j <= n; ++j) {
            const double x = 2.0 * j / n - 1, y = 2.0 * i / n - 1;
            const double hills = 0.15 * std::sin(4 * x + 1) * std::cos(3 * y) + 0.3 * std::exp(-6 * (x * x + y * y));
            mesh.positions.push_back({x, y, hills});
        }
    }
    for (uint32_t i = 0; i < n; ++i) {
        for (uint32_t j = 0; j < n; ++j) {
            const uint32_t a = i * (n + 1) + j;
            add_quad(mesh, a, a + 1, a + n + 2, a + n + 1);
        }
    }
    return mesh;
}

TriangleMesh limbed_blob(uint32_t cells) {
    const auto inside = [](const Point& p) {
        double depth = capsule(p, {-0.35, 0, 0}, {0.35, 0, 0}, 0.25);
        const auto limb = [&](const Point& from, const Point& knee, const Point& end, double radius) {
            depth = smooth_union(depth, capsule(p, from, knee, radius), 0.06);
            depth = smooth_union(depth, capsule(p, knee, end, 0.7 * radius), 0.04);
        };
        limb({-0.4, 0.1, 0}, {-0.5, 0.45, -0.3}, {-0.55, 0.5, -0.85}, 0.09);
        limb({-0.4, -0.1, 0}, {-0.45, -0.5, -0.3}, {-0.5, -0.45, -0.85}, 0.09);
        limb({0.4, 0.1, 0}, {0.5, 0.5, -0.25}, {0.45, 0.5, -0.85}, 0.09);
        limb({0.4, -0.1, 0}, {0.45, -0.45, -0.3}, {0.55, -0.5, -0.85}, 0.09);
        limb({0.45, 0, 0.1}, {0.7, 0, 0.5}, {0.9, 0.1, 0.8}, 0.12);
        return depth;
    };
    return isosurface(inside, {1.1, 0.75, 1.05}, cells);
}

TriangleMesh melted_tori(uint32_t holes, uint32_t cells) {
    const double spacing = holes == 1 ? 0 : 0.36 / std::sin(pi / holes), tube = 0.12, ring = 0.3;
    const auto inside = [=](const Point& p) {
        double depth = -1;
        for (uint32_t k = 0; k < holes; ++k) {
            const double angle = 2 * pi * k / holes;
            const Point q = p - Point{spacing * std::cos(angle), spacing * std::sin(angle), 0};
            const double from_ring = std::hypot(q[0], q[1]) - ring;
            depth = smooth_union(depth, tube - std::hypot(from_ring, q[2]), 0.05);
        }
        // In a ring of three or more tori, the hole between them would be one too many: fill it.
        if (holes > 2) depth = smooth_union(depth, capsule(p, {0, 0, 0}, {1e-3, 0, 0}, spacing - ring + 0.02), 0.05);
        return depth;
    };
    const double side = spacing + ring + tube + 0.1;
    return isosurface(inside, {side, side, std::max(0.25, holes > 2 ? spacing - ring + 0.2 : 0.25)}, cells);
}

TriangleMesh isosurface(const std::function<double(const Point&)>& inside, const Point& half_size, uint32_t cells) {
    const double step = 2 * *std::max_element(half_size.begin(), half_size.end()) / cells;
    std::array<int, 3> count{};
    for (int k = 0; k < 3; ++k) count[k] = static_cast<int>(std::ceil(2 * half_size[k] / step)) + 1;
    const auto index = [&](int x, int y, int z) { return (z * count[1] + y) * count[0] + x; };
    std::vector<Point> at;
    std::vector<double> value;
    for (int z = 0; z < count[2]; ++z) {
        for (int y = 0; y < count[1]; ++y) {
            for (int x = 0; x < count[0]; ++x) {
                at.push_back({x * step - half_size[0], y * step - half_size[1], z * step - half_size[2]});
                // Keeps values away from zero, so that no two crossings meet in a lattice point.
                const double v = inside(at.back());
                value.push_back(std::abs(v) < 0.1 * step ? std::copysign(0.1 * step, v) : v);
            }
        }
    }

    TriangleMesh mesh;
    std::map<std::pair<int, int>, uint32_t> crossings;
    const auto crossing = [&](int a, int b) {
        if (a > b) std::swap(a, b);
        const auto [entry, is_new] = crossings.try_emplace({a, b}, static_cast<uint32_t>(mesh.positions.size()));
        if (is_new) mesh.positions.push_back(at[a] + (value[a] / (value[a] - value[b])) * (at[b] - at[a]));
        return entry->second;
    };
    // Adds a triangle that faces away from `in`, a lattice point inside.
    const auto add_facing = [&](uint32_t a, uint32_t b, uint32_t c, int in) {
        const Point& p = mesh.positions[a];
        const Point normal = cross(mesh.positions[b] - p, mesh.positions[c] - p);
        if (dot(normal, p - at[in]) < 0) std::swap(b, c);
        mesh.triangles.push_back({a, b, c});
    };
    const auto march = [&](const std::array<int, 4>& corners) {
        std::vector<int> in, out;
        for (const int c : corners) (value[c] > 0 ? in : out).push_back(c);
        if (in.size() == 1)
            add_facing(crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[0], out[2]), in[0]);
        if (in.size() == 3) {
            // The triangle separates the three inner corners from the outer one: any of the three tells the side.
            add_facing(crossing(in[0], out[0]), crossing(in[1], out[0]), crossing(in[2], out[0]), in[0]);
        }
        if (in.size() == 2) {
            const uint32_t a = crossing(in[0], out[0]), b = crossing(in[0], out[1]);
            const uint32_t c = crossing(in[1], out[1]), d = crossing(in[1], out[0]);
            add_facing(a, b, c, in[0]);
            add_facing(a, c, d, in[1]);
        }
    };
    // Splits each cube into six tetrahedra around its diagonal, one per order in which the axes are walked.
    constexpr std::array<std::array<int, 3>, 6> kOrders = {
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    for (int z = 0; z + 1 < count[2]; ++z) {
        for (int y = 0; y + 1 < count[1]; ++y) {
            for (int x = 0; x + 1 < count[0]; ++x) {
                for (const auto& order : kOrders) {
                    std::array<int, 3> corner = {x, y, z};
                    std::array<int, 4> tetrahedron = {index(x, y, z), 0, 0, 0};
                    for (int k = 0; k < 3; ++k) {
                        ++corner[order[k]];
                        tetrahedron[k + 1] = index(corner[0], corner[1], corner[2]);
                    }
                    march(tetrahedron);
                }
            }
        }
    }
    return mesh;
}

TriangleMesh roughened(TriangleMesh mesh, double amplitude, uint64_t seed) {
    const std::vector<Point> normals = vertex_normals(mesh);
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const double unit = static_cast<double>(mix(mix(seed) + v) >> 11) * 0x1p-52 - 1;
        mesh.positions[v] = mesh.positions[v] + amplitude * unit * normals[v];
    }
    return mesh;
}

TriangleMesh densified(const TriangleMesh& mesh, uint32_t parts) { return Densifier(mesh, parts).result(); }

TriangleMesh soup(const TriangleMesh& mesh) {
    TriangleMesh result;
    for (const auto& t : mesh.triangles) {
        const auto first = static_cast<uint32_t>(result.positions.size());
        for (const uint32_t v : t) result.positions.push_back(mesh.positions[v]);
        result.triangles.push_back({first, first + 1, first + 2});
    }
    return result;
}

TriangleMesh together(const std::vector<TriangleMesh>& meshes, double step) {
    TriangleMesh result;
    for (size_t k = 0; k < meshes.size(); ++k) {
        const auto first = static_cast<uint32_t>(result.positions.size());
        for (const Point& p : meshes[k].positions) result.positions.push_back(p + Point{step * double(k), 0, 0});
        for (const auto& t : meshes[k].triangles)
            result.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    return result;
}

TriangleMesh edge_with_three_faces() {
    return {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
}

TriangleMesh bow_tie() {
    return {{{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {0, 1, -1}, {-1, -1, -1}},
            {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}}};
}

TriangleMesh moebius_strip(uint32_t sectors) {
    TriangleMesh mesh;
    for (uint32_t s = 0; s < sectors; ++s) {
        const double angle = 2 * pi * s / sectors;
        for (const double across : {-0.3, 0.3}) {
            const double radius = 1 + across * std::cos(angle / 2);
            mesh.positions.push_back(
                {radius * std::cos(angle), radius * std::sin(angle), across * std::sin(angle / 2)});
        }
    }
    for (uint32_t s = 0; s + 1 < sectors; ++s) add_quad(mesh, 2 * s, 2 * s + 1, 2 * s + 3, 2 * s + 2);
    add_quad(mesh, 2 * sectors - 2, 2 * sectors - 1, 0, 1);
    return mesh;
}

}  // namespace gim::corpus
