// Object File Format, ascii, three dimensions. OFF may have the prefixes ST, C and N. Their extra numbers are skipped.
#include <array>
#include <string>

#include "tools/mesh_read.h"
#include "tools/polygons.h"
#include "tools/text_scanner.h"

namespace gim {
namespace {

Error at_line(size_t line, const std::string& what) {
    return {Stage::kInput, "line " + std::to_string(line) + ": " + what};
}

// Goes to the first word that is not in a comment.
void skip_comments(TextScanner& in) {
    while (!in.at_end()) {
        TextScanner ahead = in;
        if (!ahead.word_on_line().starts_with('#')) return;
        in.next_line();
    }
}

bool is_known_keyword(std::string_view word) {
    for (const std::string_view prefix : {"ST", "C", "N"}) {
        if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
    }
    return word == "OFF";
}

}  // namespace

Result<TriangleMesh> read_off(std::string_view text, ReadContext& context) {
    TextScanner in(text);
    skip_comments(in);
    const std::string_view keyword = in.word();
    if (!is_known_keyword(keyword)) return Error{Stage::kInput, "its first word is not OFF, STOFF, COFF or NOFF"};

    std::array<int64_t, 2> counts = {};  // vertices, faces; the third number (edges) is optional in practice
    for (int64_t& count : counts) {
        skip_comments(in);
        const std::string_view word = in.word();
        if (word == "BINARY") return Error{Stage::kInput, "it is a binary OFF file; convert it to PLY"};
        const std::optional<int64_t> value = parse_integer(word);
        if (!value || *value < 0) return at_line(in.line(), "the numbers of vertices and faces are expected here");
        count = *value;
    }
    in.next_line();

    // A vertex takes at least 6 characters, a face at least 8.
    const uint64_t room = text.size() - in.offset() + 1;
    if (static_cast<uint64_t>(counts[0]) > room / 6 || static_cast<uint64_t>(counts[1]) > room / 8) {
        return Error{Stage::kInput, "it claims " + std::to_string(counts[0]) + " vertices and " +
                                        std::to_string(counts[1]) + " faces, but holds only " +
                                        std::to_string(text.size()) + " bytes (is the file cut short?)"};
    }

    const auto vertex_count = static_cast<uint64_t>(counts[0]);
    const auto face_count = static_cast<uint64_t>(counts[1]);
    if (Result<void> fits = take_memory(vertex_count, 3 * face_count, context); !fits.ok()) return fits.error();
    PolygonSoup soup;
    soup.positions.resize(static_cast<size_t>(counts[0]));
    for (std::array<double, 3>& position : soup.positions) {
        skip_comments(in);
        for (double& coordinate : position) {
            const std::optional<double> value = parse_real(in.word_on_line());
            if (!value) return at_line(in.line(), "a vertex needs three numbers (is the file cut short?)");
            coordinate = *value;
        }
        in.next_line();
    }
    std::vector<int64_t> face;
    for (int64_t f = 0; f < counts[1]; ++f) {
        skip_comments(in);
        const std::optional<int64_t> size = parse_integer(in.word_on_line());
        if (!size || *size < 0) return at_line(in.line(), "a face is expected here (is the file cut short?)");
        face.clear();
        for (int64_t i = 0; i < *size; ++i) {
            const std::optional<int64_t> index = parse_integer(in.word_on_line());
            if (!index) return at_line(in.line(), "the face has fewer vertices than it says");
            face.push_back(*index);
        }
        soup.add_face(face);
        in.next_line();
    }
    return triangulate(std::move(soup));
}

}  // namespace gim
