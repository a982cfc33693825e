// STL, ascii and binary. Every facet has its own three vertices. The cleaning stage welds them. The two bytes after a
// binary facet, where some programs keep colours, are skipped.
#include <array>
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

uint64_t claimed_facets(std::string_view text) { return load_u32(text.data() + kHeaderSize - 4); }

// The number of facets to read: what the header claims. Programs that write while they compute may leave 0 or -1 there.
Result<uint64_t> count_facets(std::string_view text, ReadContext& context) {
    if (text.size() < kHeaderSize) return Error{Stage::kInput, "it ends inside the header of a binary STL file"};
    const uint64_t claimed = claimed_facets(text);
    const uint64_t body = text.size() - kHeaderSize;
    const uint64_t room = body / kFacetSize;
    if ((claimed == 0 || claimed == UINT32_MAX) && room > 0 && body % kFacetSize == 0) {
        context.warn("its header does not tell the number of triangles; the size of the file gives " +
                     std::to_string(room));
        return room;
    }
    if (claimed > room) {
        return Error{Stage::kInput, "it claims " + std::to_string(claimed) + " triangles, but holds only " +
                                        std::to_string(text.size()) + " bytes (is the file cut short?)"};
    }
    if (claimed == 0) return Error{Stage::kInput, "it has no triangles"};
    if (room > claimed) {
        context.warn("its header claims " + std::to_string(claimed) + " triangles, but there is room for " +
                     std::to_string(room) + "; what follows the claimed ones is left out");
    }
    return claimed;
}

Result<TriangleMesh> read_binary(std::string_view text, ReadContext& context) {
    const Result<uint64_t> counted = count_facets(text, context);
    if (!counted.ok()) return counted.error();
    const uint64_t facets = counted.value();
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

// Reads words, wherever their lines end.
class AsciiReader {
  public:
    AsciiReader(std::string_view text, ReadContext& context) : in_(text), context_(context) {}

    Result<TriangleMesh> read() {
        while (!in_.at_end()) {
            const std::string_view word = in_.word();
            if (equals_ignoring_case(word, "vertex")) {
                if (const Result<void> read = read_vertex(); !read.ok()) return read.error();
            } else if (begins_ignoring_case(word, "endsolid")) {
                close_loop();
                complete_ = true;
                skip_name();
            } else if (begins_ignoring_case(word, "solid")) {
                complete_ = false;
                skip_name();
            } else if (equals_ignoring_case(word, "outer") || begins_ignoring_case(word, "end") ||
                       equals_ignoring_case(word, "facet")) {
                close_loop();
            }
        }
        if (!complete_) return Error{Stage::kInput, "'endsolid' is missing (is the file cut short?)"};
        return triangulate(std::move(soup_), context_);
    }

  private:
    Result<void> read_vertex() {
        const size_t line = in_.line();
        std::array<double, 3> position = {};
        for (double& coordinate : position) {
            const std::string_view word = in_.word();
            const std::optional<double> value = parse_real(word);
            if (!value) {
                const std::string wrong =
                    word.empty() ? " (is the file cut short?)" : ", not " + describe_wrong_number(word);
                return Error{Stage::kInput, "line " + std::to_string(line) + ": a vertex needs three numbers" + wrong};
            }
            coordinate = *value;
        }
        constexpr uint64_t kBytesPerCorner = kBytesPerFacet / 3 + sizeof(int64_t);
        if (!context_.memory.try_take(kBytesPerCorner)) return context_.memory.over_limit("its triangles take memory");
        loop_.push_back(static_cast<int64_t>(soup_.positions.size()));
        soup_.positions.push_back(position);
        return {};
    }

    void close_loop() {
        if (!loop_.empty()) soup_.add_face(loop_);
        loop_.clear();
    }

    // Skips the name of a solid, which may hold any word. A facet on the same line is no part of the name.
    void skip_name() {
        const TextScanner after_keyword = in_;
        const size_t line = in_.line();
        for (TextScanner at = in_; !at.at_end() && at.line() == line;) {
            const TextScanner before = at;
            if (!equals_ignoring_case(at.word_on_line(), "facet")) continue;
            TextScanner next = at;
            if (!equals_ignoring_case(next.word_on_line(), "normal")) continue;
            in_ = before;
            return;
        }
        in_ = after_keyword;
        in_.next_line();
    }

    TextScanner in_;
    ReadContext& context_;
    PolygonSoup soup_;
    std::vector<int64_t> loop_;
    bool complete_ = false;  // the latest solid has ended
};

}  // namespace

bool is_whole_binary_stl(std::string_view text) {
    return text.size() >= kHeaderSize && text.size() == kHeaderSize + kFacetSize * claimed_facets(text);
}

bool is_ascii_stl(std::string_view text) {
    constexpr size_t kSniffed = size_t{1} << 16;
    TextScanner in(text.substr(0, kSniffed));
    if (!begins_ignoring_case(in.word(), "solid")) return false;
    // The line end after the name may be missing; the name may be, too.
    for (std::string_view word = in.word_on_line(); !word.empty(); word = in.word_on_line()) {
        if (equals_ignoring_case(word, "facet") && equals_ignoring_case(TextScanner(in).word_on_line(), "normal")) {
            return true;
        }
    }
    const std::string_view word = in.word();
    return equals_ignoring_case(word, "facet") || begins_ignoring_case(word, "endsolid");
}

Result<TriangleMesh> read_stl(std::string_view text, ReadContext& context) {
    // Some binary files begin with "solid" too. Their size, what follows the name, or zero bytes tell them apart.
    if (is_whole_binary_stl(text)) return read_binary(text, context);
    const bool begins_as_text = begins_ignoring_case(TextScanner(text).word(), "solid");
    const bool is_text = is_ascii_stl(text) || (begins_as_text && text.find('\0') == std::string_view::npos);
    return is_text ? AsciiReader(text, context).read() : read_binary(text, context);
}

}  // namespace gim
