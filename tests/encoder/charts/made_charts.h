// Small multi-chart images made by hand from integers, as the file writer gets them: charts of any outline, zipped path
// by path, at several levels.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "encoder/charts/chart_levels.h"
#include "encoder/charts/glue_charts.h"
#include "encoder/surface/topology_summary.h"
#include "format/band_code.h"

namespace gim::test {

struct MadeChart {
    uint32_t columns = 3, rows = 3;                                 // of the box
    int32_t atlas_column = 0, atlas_row = 0;                        // of its first sample in the rectangle
    uint32_t path_count = 1;                                        // the border is cut into so many about equal paths
    std::function<bool(uint32_t column, uint32_t row)> is_defined;  // at full resolution
    std::function<Vec3(uint32_t column, uint32_t row)> position;    // of the first of glued samples
};

// One level: the charts beside each other in one image, zipped, and their places in it.
struct MadeLevel {
    MultiChartImage image;
    std::vector<uint32_t> first_column;
    std::vector<std::vector<uint32_t>> loops;  // as LevelBorders has them
};

// Walks along both paths at an even pace.
inline std::vector<ZipStep> even_zipper(int64_t first, int64_t second) {
    std::vector<ZipStep> steps;
    for (int64_t a = first, b = second; a > 0 || b > 0;) {
        const int64_t lag = 2 * (a * second - b * first), longer = std::max(first, second);
        ZipStep step = ZipStep::kBoth;
        if (b == 0 || (a > 0 && lag > longer)) step = ZipStep::kFirst;
        if (a == 0 || (b > 0 && lag < -longer)) step = ZipStep::kSecond;
        a -= step != ZipStep::kSecond;
        b -= step != ZipStep::kFirst;
        steps.push_back(step);
    }
    return steps;
}

inline MadeLevel make_level(const std::vector<MadeChart>& charts, const std::vector<uint32_t>& mates, uint32_t level) {
    MadeLevel made;
    SampleMask& mask = made.image.mask;
    std::vector<SampleMask> own;
    for (const MadeChart& chart : charts) {
        SampleMask m{halved(chart.columns, level), halved(chart.rows, level), {}};
        for (uint32_t r = 0; r < m.height; ++r)
            for (uint32_t c = 0; c < m.width; ++c) m.defined.push_back(chart.is_defined(c << level, r << level));
        made.first_column.push_back(mask.width);
        mask.width += m.width + 1;
        mask.height = std::max(mask.height, m.height);
        own.push_back(std::move(m));
    }
    mask.defined.assign(size_t{mask.width} * mask.height, 0);
    for (size_t k = 0; k < charts.size(); ++k) {
        const auto in_image = [&](uint32_t i) {
            return i / own[k].width * mask.width + made.first_column[k] + i % own[k].width;
        };
        for (uint32_t i = 0; i < own[k].defined.size(); ++i) mask.defined[in_image(i)] = own[k].defined[i];
        made.loops.push_back(trace_borders(own[k]).at(0));
        const std::vector<uint32_t>& loop = made.loops.back();
        made.image.seams.loops.push_back({in_image(loop[0]), charts[k].path_count});
        const auto begin = [&](size_t p) {
            return (loop.size() * p + charts[k].path_count / 2) / charts[k].path_count;
        };
        for (uint32_t p = 0; p < charts[k].path_count; ++p) {
            const auto length = static_cast<uint32_t>(begin(p + 1) - begin(p));
            made.image.seams.paths.push_back({mates[made.image.seams.paths.size()], length});
        }
    }
    const auto& paths = made.image.seams.paths;
    for (uint32_t p = 0; p < paths.size(); ++p) {
        if (mates[p] != kNoMate && mates[p] > p)
            made.image.seams.zippers.push_back(even_zipper(paths[p].length, paths[mates[p]].length));
    }
    made.image.positions.assign(mask.defined.size(), Vec3::Zero());
    auto gluing = glue_charts(mask, made.image.seams);
    if (!gluing.ok()) {
        std::fprintf(stderr, "%s\n", gluing.error().message.c_str());
        std::abort();
    }
    made.image.gluing = std::move(gluing.value());
    return made;
}

inline TopologySummary topology_of(const GeometryImage& image) {
    const Mesh mesh = surface_of(image).mesh;
    return analyse_topology(mesh.triangles, mesh.positions.size()).summary;
}

// Positions and masks of the boxes. All samples of a point have the position of its first sample.
inline void take_samples(const std::vector<MadeChart>& charts, const MadeLevel& made,
                         const std::vector<uint32_t>& point, ChartLevels* images) {
    std::vector<Vec3> all(point.size(), Vec3::Zero());
    const auto for_each_sample = [&](const auto& f) {
        for (size_t k = 0; k < charts.size(); ++k) {
            for (uint32_t r = 0; r < charts[k].rows; ++r) {
                for (uint32_t c = 0; c < charts[k].columns; ++c)
                    f(k, c, r, r * made.image.mask.width + made.first_column[k] + c);
            }
        }
    };
    for_each_sample([&](size_t k, uint32_t c, uint32_t r, uint32_t i) {
        if (point[i] == i) all[i] = charts[k].position(c, r);
    });
    images->positions.resize(charts.size());
    images->defined.resize(charts.size());
    for_each_sample([&](size_t k, uint32_t, uint32_t, uint32_t i) {
        images->positions[k].push_back(point[i] == kNone ? Vec3::Zero() : all[point[i]]);
        images->defined[k].push_back(point[i] != kNone);
    });
}

// mates: per path, chart after chart. The caller chooses the topology.
inline ChartLevels made_images(uint32_t width, uint32_t height, const std::vector<MadeChart>& charts,
                               const std::vector<uint32_t>& mates, uint32_t level_count) {
    ChartLevels images;
    images.image.mask.width = width;  // the writer needs no more of it
    images.image.mask.height = height;
    images.mates = mates;
    for (const MadeChart& chart : charts)
        images.charts.push_back({chart.columns, chart.rows, chart.atlas_column, chart.atlas_row, chart.path_count});
    for (uint32_t level = 0; level < level_count; ++level) {
        MadeLevel made = make_level(charts, mates, level);
        const std::vector<uint32_t>& point = made.image.gluing.representative;
        LevelBorders borders;
        borders.loops = made.loops;
        for (const SeamPath& path : made.image.seams.paths) borders.lengths.push_back(path.length);
        borders.zippers = made.image.seams.zippers;
        borders.size.triangles = static_cast<uint32_t>(surface_of(made.image).mesh.triangles.size());
        for (uint32_t i = 0; i < point.size(); ++i) borders.size.vertices += point[i] == i;
        images.levels.push_back(std::move(borders));
        if (level == 0) take_samples(charts, made, point, &images);
    }
    return images;
}

// ---- surfaces -------------------------------------------------------------------------------------------------------

// A rectangle, all of which is defined.
inline MadeChart rectangle_chart(uint32_t columns, uint32_t rows, uint32_t path_count) {
    MadeChart chart;
    chart.columns = columns;
    chart.rows = rows;
    chart.path_count = path_count;
    chart.is_defined = [](uint32_t, uint32_t) { return true; };
    chart.position = [](uint32_t c, uint32_t r) { return Vec3(c * 100, r * 90 + c * c, c * r * 7); };
    return chart;
}

// A disk of that radius in a box with `room` free samples around it; z of `side` times a paraboloid.
inline MadeChart disk_chart(uint32_t radius, uint32_t room, uint32_t path_count, int side) {
    MadeChart chart;
    chart.columns = chart.rows = 2 * (radius + room) + 1;
    chart.path_count = path_count;
    const auto square = [=](uint32_t c, uint32_t r) {
        const int x = static_cast<int>(c) - static_cast<int>(radius + room),
                  y = static_cast<int>(r) - static_cast<int>(radius + room);
        return x * x + y * y;
    };
    const auto limit = static_cast<int>(radius * radius + radius / 2);
    chart.is_defined = [=](uint32_t c, uint32_t r) { return square(c, r) <= limit; };
    chart.position = [=](uint32_t c, uint32_t r) {
        // The lower side is mirrored, so that the border runs the other way round.
        const double x = side > 0 ? c : 2.0 * (radius + room) - c;
        return Vec3(x * 100, r * 100.0, side * (limit - square(c, r)) * 400 / limit);
    };
    return chart;
}

// Two disks, of different sizes if wanted, make a sphere.
inline ChartLevels pillow(uint32_t radius, uint32_t other_radius, uint32_t level_count) {
    std::vector<MadeChart> charts = {disk_chart(radius, 1, 3, 1), disk_chart(other_radius, 2, 3, -1)};
    charts[1].atlas_column = static_cast<int32_t>(2 * radius + 1);
    charts[1].atlas_row = -1;
    const uint32_t longer = std::max(2 * radius + 3, 2 * other_radius + 4);
    return made_images(2 * (radius + other_radius) + 8, longer, charts, {5, 4, 3, 2, 1, 0}, level_count);
}

// A rectangle whose opposite sides are glued.
inline ChartLevels torus_of_one_chart(uint32_t side, uint32_t level_count) {
    MadeChart chart = rectangle_chart(side, side, 4);
    const int half = static_cast<int>(side / 2);
    chart.position = [half](uint32_t c, uint32_t r) {
        // Two triangle waves a direction instead of sine and cosine.
        const auto wave = [&](int t) { return std::abs((t % (2 * half)) - half); };
        const int u = static_cast<int>(c), v = static_cast<int>(r), out = 600 + 40 * wave(v);
        return Vec3(out * (wave(u) * 2 - half), out * (wave(u + half / 2) * 2 - half),
                    9000 * (wave(v + half / 2) * 2 - half) / half);
    };
    return made_images(side, side, {chart}, {2, 3, 0, 1}, level_count);
}

// Two rectangles glued along one path. The other paths are boundaries.
inline ChartLevels open_sheet(uint32_t level_count) {
    std::vector<MadeChart> charts = {rectangle_chart(10, 7, 4), rectangle_chart(6, 11, 4)};
    charts[1].atlas_column = 11;
    charts[1].position = [](uint32_t c, uint32_t r) { return Vec3(900 + c * 110, r * 60 + 40, c * r * 5); };
    return made_images(17, 11, charts, {kNone, 7, kNone, kNone, kNone, kNone, kNone, 1}, level_count);
}

}  // namespace gim::test
