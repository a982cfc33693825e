// Wavefront OBJ: "v" and "f" lines; everything else (normals, texture coordinates, groups, materials) is skipped.
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

}  // namespace

Result<TriangleMesh> read_obj(std::string_view text) {
    PolygonSoup soup;
    TextScanner in(text);
    std::vector<int64_t> face;
    while (!in.at_end()) {
        const size_t line = in.line();
        const std::string_view keyword = in.word_on_line();
        if (keyword == "v") {
            std::array<double, 3> position = {};
            for (double& coordinate : position) {
                const std::optional<double> value = parse_real(in.word_on_line());
                if (!value) return at_line(line, "a vertex needs three numbers (is the file cut short?)");
                coordinate = *value;
            }
            soup.positions.push_back(position);
        } else if (keyword == "f") {
            face.clear();
            for (std::string_view word = in.word_on_line(); !word.empty(); word = in.word_on_line()) {
                if (word == "\\") {  // the face goes on in the next line
                    in.next_line();
                    continue;
                }
                const std::optional<int64_t> index = parse_integer(word.substr(0, word.find('/')));
                if (!index || *index == 0) {
                    return at_line(line, "'" + std::string(word.substr(0, 40)) + "' is no vertex of a face");
                }
                // 1 is the first vertex of the file, -1 the latest one.
                face.push_back(*index > 0 ? *index - 1 : static_cast<int64_t>(soup.positions.size()) + *index);
            }
            if (face.size() < 3) return at_line(line, "a face needs three vertices (is the file cut short?)");
            soup.add_face(face);
        }
        in.next_line();
    }
    if (soup.positions.empty() && soup.sizes.empty()) return Error{Stage::kInput, "it has no 'v' and no 'f' lines"};
    return triangulate(std::move(soup));
}

}  // namespace gim
