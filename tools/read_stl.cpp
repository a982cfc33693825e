// STL, ascii and binary. Every facet has its own three vertices. The cleaning stage welds them.
#include <array>
#include <cctype>
#include <cstring>
#include <string>

#include "tools/little_endian.h"
#include "tools/mesh_read.h"
#include "tools/polygons.h"
#include "tools/text_scanner.h"

namespace gim {
namespace {

constexpr size_t kHeaderSize = 84;  // 80 bytes of anything, then the number of facets
constexpr size_t kFacetSize = 50;   // normal, three corners, two bytes of anything
constexpr size_t kBytesPerFacet = 3 * sizeof(TriangleMesh{}.positions[0]) + sizeof(TriangleMesh{}.triangles[0]);

uint64_t claimed_size(std::string_view text) {
    return kHeaderSize + kFacetSize * uint64_t{load_u32(text.data() + kHeaderSize - 4)};
}

bool equals_ignoring_case(std::string_view word, std::string_view lower) {
    if (word.size() != lower.size()) return false;
    for (size_t i = 0; i < word.size(); ++i) {
        if (std::tolower(static_cast<unsigned char>(word[i])) != lower[i]) return false;
    }
    return true;
}

Result<TriangleMesh> read_binary(std::string_view text, ReadContext& context) {
    if (text.size() < kHeaderSize) return Error{Stage::kInput, "it ends inside the header of a binary STL file"};
    if (claimed_size(text) > text.size()) {
        return Error{Stage::kInput, "it claims " + std::to_string(load_u32(text.data() + kHeaderSize - 4)) +
                                        " triangles, but holds only " + std::to_string(text.size()) +
                                        " bytes (is the file cut short?)"};
    }
    const size_t facets = load_u32(text.data() + kHeaderSize - 4);
    if (facets == 0) return Error{Stage::kInput, "it has no triangles"};
    const Result<void> fits =
        context.memory.take(facets, kBytesPerFacet, "its " + std::to_string(facets) + " triangles");
    if (!fits.ok()) return fits.error();
    TriangleMesh mesh;
    mesh.positions.reserve(3 * facets);
    mesh.triangles.reserve(facets);
    for (size_t f = 0; f < facets; ++f) {
        const char* corner = text.data() + kHeaderSize + f * kFacetSize + 12;
        const auto first = static_cast<uint32_t>(3 * f);
        for (int i = 0; i < 3; ++i, corner += 12) {
            mesh.positions.push_back({load_f32(corner), load_f32(corner + 4), load_f32(corner + 8)});
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

Result<TriangleMesh> read_ascii(std::string_view text) {
    PolygonSoup soup;
    TextScanner in(text);
    std::vector<int64_t> loop;
    bool complete = false;  // the latest solid has ended
    while (!in.at_end()) {
        const size_t line = in.line();
        std::string_view word = in.word_on_line();
        if (equals_ignoring_case(word, "solid")) {
            complete = false;
        } else if (equals_ignoring_case(word, "endsolid")) {
            complete = true;
        } else if (equals_ignoring_case(word, "outer")) {
            loop.clear();
        } else if (equals_ignoring_case(word, "vertex")) {
            std::array<double, 3> position = {};
            for (double& coordinate : position) {
                const std::optional<double> value = parse_real(in.word_on_line());
                if (!value) {
                    return Error{Stage::kInput, "line " + std::to_string(line) +
                                                    ": a vertex needs three numbers (is the file cut short?)"};
                }
                coordinate = *value;
            }
            loop.push_back(static_cast<int64_t>(soup.positions.size()));
            soup.positions.push_back(position);
        } else if (equals_ignoring_case(word, "endloop")) {
            soup.add_face(loop);
            loop.clear();
        }
        in.next_line();
    }
    if (!complete) return Error{Stage::kInput, "'endsolid' is missing (is the file cut short?)"};
    return triangulate(std::move(soup));
}

}  // namespace

Result<TriangleMesh> read_stl(std::string_view text, ReadContext& context) {
    // Some binary files begin with "solid" too. Their size or their zero bytes tell them apart.
    if (text.size() >= kHeaderSize && claimed_size(text) == text.size()) return read_binary(text, context);
    TextScanner in(text);
    const bool is_text = equals_ignoring_case(in.word(), "solid") && text.find('\0') == std::string_view::npos;
    return is_text ? read_ascii(text) : read_binary(text, context);
}

}  // namespace gim
