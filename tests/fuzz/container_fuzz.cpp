// libFuzzer: header, index, sidebands, chart tables and borders. Corrects the checksum of header and index first, so
// that the fuzzer gets behind it.
#include <algorithm>
#include <array>
#include <vector>

#include "decoder/pyramid/range_decoder.h"
#include "format/chart_border.h"
#include "format/chart_table.h"
#include "format/checksum.h"
#include "format/container.h"
#include "format/seam.h"
#include "format/sideband_code.h"

namespace {

using namespace gim;

// Reads the bytes as a chart table of that rectangle, and as the borders of one of its levels.
void read_charts(std::span<const uint8_t> bytes, uint32_t width, uint32_t height, uint32_t level_count) {
    Header header;
    header.layout = FileLayout::kCharts;
    header.width = width;
    header.height = height;
    header.level_count = level_count;
    ContainerLimits limits;
    limits.max_samples = 1 << 16;
    ChartTableReader reader;
    std::vector<uint32_t> mates(kMaxChartPaths);
    if (reader.open(bytes, header, limits) != Status::kOk) return;
    std::vector<ChartBox> charts(reader.chart_count());
    for (ChartBox& chart : charts)
        if (reader.next(&chart, mates.data()) != Status::kOk) return;
    if (reader.finish() != Status::kOk) return;
    std::vector<BorderPath> paths(reader.path_count());
    for (uint32_t p = 0; p < paths.size(); ++p) {
        if (mates[p] != kNoMate && (mates[p] >= paths.size() || mates[mates[p]] != p)) __builtin_trap();
        paths[p].mate = mates[p];
    }
    // The coarsest level, and a finer one that it guides.
    RangeDecoder decoder(bytes);
    BorderModels models;
    BorderCoder<RangeDecoder> coder(&decoder, &models);
    std::vector<std::vector<uint32_t>> coarse;
    for (const uint32_t finer : {0u, 1u}) {
        uint32_t path = 0;
        for (size_t c = 0; c < charts.size(); ++c) {
            BorderChart border;
            border.columns = finer ? 2 * charts[c].columns - 1 : charts[c].columns;
            border.rows = finer ? 2 * charts[c].rows - 1 : charts[c].rows;
            border.first_path = path;
            border.path_count = charts[c].path_count;
            std::vector<uint32_t> samples(size_t{border.columns} * border.rows);
            border.samples = samples.data();
            if (finer) {
                border.coarse = coarse[c].data();
                border.coarse_columns = charts[c].columns;
                border.coarse_border_length = static_cast<uint32_t>(coarse[c].size());
                for (uint32_t p = path; p < path + border.path_count; ++p) paths[p].keep_as_coarse();
            }
            if (!coder.code_border(border, paths.data())) return;
            for (uint32_t k = 0; k < border.border_length && k < samples.size(); ++k)
                if (samples[k] >= samples.size()) __builtin_trap();
            samples.resize(std::min<size_t>(border.border_length, samples.size()));
            if (!finer) coarse.push_back(samples);
            for (const uint32_t end = path + border.path_count; path < end; ++path) {
                if (mates[path] >= path) continue;
                const BorderPath &first = paths[mates[path]], &second = paths[path];
                (void)coder.code_zipper(
                    first, second, [] { return ZipStep::kBoth; },
                    [&](uint32_t i, uint32_t j) {
                        if (i > first.length || j > second.length) __builtin_trap();
                    });
            }
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size > 4) read_charts({data + 4, size - 4}, data[0] + 2u, data[1] + 2u, data[2] % kMaxLevels + 1u);
    std::vector<uint8_t> bytes(data, data + size);
    ByteReader reader(bytes);
    uint64_t index_size = 0;
    if (reader.skip(8) && reader.read_leb128(&index_size) && index_size >= 13 && index_size <= bytes.size()) {
        const auto body = static_cast<size_t>(index_size) - 4;
        const uint32_t crc = crc32(std::span(bytes).first(body));
        for (size_t i = 0; i < 4; ++i) bytes[body + i] = static_cast<uint8_t>(crc >> (8 * i));
    }
    Header header;
    if (parse_header(bytes, {}, &header) == Status::kOk) {
        ChunkWalk walk(header);
        Chunk chunk;
        uint64_t offset = 0;
        std::span<const uint8_t> payload;
        while (walk.next(&chunk, &offset)) (void)(read_payload(bytes, chunk, offset, &payload) == Status::kOk);
    }

    std::array<CutPath, kMaxCutPaths> paths;
    ParsedSideband parsed;
    if (parse_sideband({data, size}, paths, &parsed) == Status::kOk) {
        SeamTable table;
        if (build_seam_table(parsed.node_side, parsed.start, std::span(paths).first(parsed.path_count), &table) ==
            Status::kOk) {
            for (uint32_t side = 3; side <= 1025; side = 2 * side - 1) {
                if (!level_is_closed(table, side)) continue;
                std::vector<uint32_t> class_of(ring_length(side));
                ring_classes(table, side, class_of);
                if (*std::max_element(class_of.begin(), class_of.end()) + 1 != ring_class_count(table, side))
                    __builtin_trap();
            }
        }
    }
    return 0;
}
