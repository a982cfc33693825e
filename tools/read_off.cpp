// Object File Format in three dimensions: OFF with the prefixes ST, C and N, ascii and binary. Skips normals and
// texture coordinates. If colours are wanted, reads those of vertices (C) and of faces.
//
// The format is a stream of words, but most files have a vertex or a face on each line, some with more numbers than
// they should. Lines come first; if they do not add up, words.
#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "tools/little_endian.h"
#include "tools/mesh_read.h"
#include "tools/polygons.h"
#include "tools/text_scanner.h"

namespace gim {
namespace {

using Color = std::array<float, 3>;

constexpr size_t kBinaryCounts = 12;  // bytes: vertices, faces, edges

Error at_line(size_t line, const std::string& what) {
    return {Stage::kInput, "line " + std::to_string(line) + ": " + what};
}

// What the keyword says about a vertex, and the counts.
struct Head {
    bool has_normal = false, has_color = false, has_texcoord = false;
    bool is_four_dimensional = false, has_dimension = false;  // refused
    bool is_binary = false;
    uint64_t vertices = 0, faces = 0;
    TextScanner body{{}, {}};  // at the first vertex

    size_t numbers_before_color() const { return has_normal ? 6 : 3; }
};

bool remove_prefix(std::string_view& word, std::string_view prefix) {
    if (!word.starts_with(prefix)) return false;
    word.remove_prefix(prefix.size());
    return true;
}

// [ST][C][N][4][n]OFF, or "off" alone. Returns false if the word is no keyword.
bool parse_keyword(std::string_view word, Head& result) {
    if (equals_ignoring_case(word, "off")) return true;
    Head head;
    head.has_texcoord = remove_prefix(word, "ST");
    head.has_color = remove_prefix(word, "C");
    head.has_normal = remove_prefix(word, "N");
    head.is_four_dimensional = remove_prefix(word, "4");
    head.has_dimension = remove_prefix(word, "n");
    if (word != "OFF") return false;
    result = head;
    return true;
}

uint32_t load_big_endian(const char* bytes) {
    const uint32_t x = load_u32(bytes);
    return x >> 24 | (x >> 8 & 0xFF00) | (x << 8 & 0xFF0000) | x << 24;
}

Error too_short(const Head& head, std::string_view text) {
    return {Stage::kInput, "it claims " + std::to_string(head.vertices) + " vertices and " +
                               std::to_string(head.faces) + " faces, but holds only " + std::to_string(text.size()) +
                               " bytes (is the file cut short?)"};
}

Result<Head> read_head(std::string_view text) {
    Head head;
    TextScanner in(text, {.comments = true});
    TextScanner before = in;
    const std::string_view keyword = in.word();
    if (!parse_keyword(keyword, head)) {
        if (!parse_integer(keyword)) return Error{Stage::kInput, "its first word is not OFF, STOFF, COFF or NOFF"};
        in = before;  // the keyword is optional
    }
    if (head.is_four_dimensional || head.has_dimension) {
        return Error{Stage::kInput, "it is " + std::string(keyword) +
                                        ", whose vertices have another number of coordinates than three; export it "
                                        "in three dimensions"};
    }
    before = in;
    if (in.word() == "BINARY") {
        in.next_line();
        if (text.size() - in.offset() < kBinaryCounts) return Error{Stage::kInput, "it ends inside the header"};
        const char* counts = text.data() + in.offset();
        head.is_binary = true;
        head.vertices = load_big_endian(counts);
        head.faces = load_big_endian(counts + 4);
        head.body = in;
        return head;
    }
    in = before;
    std::array<size_t, 2> lines = {};
    for (uint64_t* count : {&head.vertices, &head.faces}) {
        const std::optional<int64_t> value = parse_integer(in.word());
        if (!value || *value < 0) return at_line(in.line(), "the numbers of vertices and faces are expected here");
        *count = static_cast<uint64_t>(*value);
        lines = {lines[1], in.line()};
    }
    // The third number (edges) is optional in practice. It stands on the line of the others, or alone as they do.
    TextScanner after = in;
    if (lines[0] != lines[1]) (void)after.at_end();
    const bool has_edges = parse_integer(after.word_on_line()).has_value();
    if (has_edges && (lines[0] == lines[1] || TextScanner(after).word_on_line().empty())) in = after;
    if (TextScanner(in).word_on_line().empty()) in.next_line();
    head.body = in;
    return head;
}

// Reads "255 0 0" or "1.0 0 0".
std::optional<Color> read_color(TextScanner& in) {
    Color color = {};
    for (float& channel : color) {
        const std::optional<double> value = parse_real(in.word_on_line());
        if (!value) return std::nullopt;
        channel = static_cast<float>(*value);
    }
    return color;
}

class AsciiReader {
  public:
    AsciiReader(const Head& head, bool wants_colors) : head_(head), in_(head.body), wants_colors_(wants_colors) {}

    // A vertex or face begins on each line, and the rest of a line is colours.
    Result<PolygonSoup> read_lines() { return read(true); }
    // Lines have no meaning.
    Result<PolygonSoup> read_words() { return read(false); }

  private:
    Result<PolygonSoup> read(bool by_lines) {
        by_lines_ = by_lines;
        soup_.positions.reserve(head_.vertices);
        for (uint64_t v = 0; v < head_.vertices; ++v) {
            if (const Result<void> vertex = read_vertex(); !vertex.ok()) return vertex.error();
        }
        for (uint64_t f = 0; f < head_.faces; ++f) {
            if (const Result<void> face = read_face(); !face.ok()) return face.error();
        }
        const bool are_normals = !head_.has_color && has_negative_;
        if (are_normals || soup_.vertex_colors.size() != soup_.positions.size()) soup_.vertex_colors.clear();
        if (colored_faces_ == 0) soup_.face_colors.clear();
        return std::move(soup_);
    }

    // The first word of a record, and the others. In lines they are on one line.
    std::string_view first_word() { return in_.word(); }
    std::string_view next_word() { return by_lines_ ? in_.word_on_line() : in_.word(); }

    Result<void> read_vertex() {
        std::array<double, 3> position = {};
        for (size_t k = 0; k < 3; ++k) {
            const std::string_view word = k == 0 ? first_word() : next_word();
            const std::optional<double> value = parse_real(word);
            if (!value) {
                return at_line(in_.line(), "a vertex needs three numbers" +
                                               (word.empty() ? " (is the file cut short?)"
                                                             : ", not " + describe_wrong_number(word)));
            }
            position[k] = *value;
        }
        soup_.positions.push_back(position);
        if (by_lines_) {
            for (size_t k = 3; k < head_.numbers_before_color(); ++k) (void)in_.word_on_line();
            keep_vertex_color();
            in_.next_line();
            return {};
        }
        const size_t others =
            head_.numbers_before_color() - 3 + (head_.has_color ? 4 : 0) + (head_.has_texcoord ? 2 : 0);
        for (size_t k = 0; k < others; ++k) (void)in_.word();
        return {};
    }

    // Files without C whose vertices have colours all the same have them after the coordinates.
    void keep_vertex_color() {
        if (!wants_colors_ || (head_.has_texcoord && !head_.has_color)) return;
        const std::optional<Color> color = read_color(in_);
        if (!color) return;
        soup_.vertex_colors.push_back(*color);
        has_negative_ = has_negative_ || *std::min_element(color->begin(), color->end()) < 0;
    }

    Result<void> read_face() {
        const std::string_view word = first_word();
        const std::optional<int64_t> size = parse_integer(word);
        if (!size || *size < 0) return at_line(in_.line(), "a face is expected here (is the file cut short?)");
        face_.clear();
        for (int64_t i = 0; i < *size; ++i) {
            const std::optional<int64_t> index = parse_integer(next_word());
            if (!index) return at_line(in_.line(), "the face has fewer vertices than it says");
            face_.push_back(*index);
        }
        soup_.add_face(face_);
        if (!by_lines_) return {};
        if (wants_colors_) {
            const std::optional<Color> color = read_color(in_);
            soup_.face_colors.push_back(color.value_or(kNoColor));
            colored_faces_ += color ? 1 : 0;
        }
        in_.next_line();
        return {};
    }

    const Head& head_;
    TextScanner in_;
    bool wants_colors_;
    bool by_lines_ = true;
    PolygonSoup soup_;
    std::vector<int64_t> face_;
    size_t colored_faces_ = 0;
    bool has_negative_ = false;  // among what may be colours of vertices
};

// Geomview's binary form: big-endian, float32 and int32. A face ends with the number of its colour's floats.
class BinaryReader {
  public:
    BinaryReader(const Head& head, std::string_view body, bool wants_colors)
        : head_(head), body_(body), wants_colors_(wants_colors) {}

    Result<PolygonSoup> read() {
        soup_.positions.reserve(head_.vertices);
        for (uint64_t v = 0; v < head_.vertices; ++v) read_vertex();
        for (uint64_t f = 0; f < head_.faces && !failed_; ++f) read_face();
        if (failed_) return Error{Stage::kInput, "a face reaches beyond its end (is the file cut short?)"};
        if (!colored_) soup_.face_colors.clear();
        return std::move(soup_);
    }

  private:
    uint32_t next() {
        failed_ = failed_ || body_.size() - position_ < 4;
        if (failed_) return 0;
        position_ += 4;
        return load_big_endian(body_.data() + position_ - 4);
    }
    float next_float() { return std::bit_cast<float>(next()); }

    void read_vertex() {
        std::array<double, 3> position = {};
        for (double& coordinate : position) coordinate = static_cast<double>(next_float());
        soup_.positions.push_back(position);
        for (size_t k = 3; k < head_.numbers_before_color(); ++k) (void)next();
        if (head_.has_color) {
            const Color color = {next_float(), next_float(), next_float()};
            (void)next();  // alpha
            if (wants_colors_) soup_.vertex_colors.push_back(color);
        }
        for (int k = 0; head_.has_texcoord && k < 2; ++k) (void)next();
    }

    void read_face() {
        const uint32_t size = next();
        if (size > (body_.size() - position_) / 4) failed_ = true;
        face_.clear();
        for (uint32_t i = 0; i < size && !failed_; ++i) face_.push_back(static_cast<int32_t>(next()));
        soup_.add_face(face_);
        const uint32_t channels = next();
        if (channels > (body_.size() - position_) / 4) failed_ = true;
        Color color = kNoColor;
        for (uint32_t i = 0; i < channels && !failed_; ++i) {
            const float value = next_float();
            if (i < 3 && channels >= 3) color[i] = value;
        }
        colored_ = colored_ || channels >= 3;
        if (wants_colors_) soup_.face_colors.push_back(color);
    }

    const Head& head_;
    std::string_view body_;
    bool wants_colors_;
    size_t position_ = 0;
    bool failed_ = false;
    bool colored_ = false;
    PolygonSoup soup_;
    std::vector<int64_t> face_;
};

bool has_only_known_corners(const PolygonSoup& soup) {
    const auto count = static_cast<int64_t>(soup.positions.size());
    return std::all_of(soup.corners.begin(), soup.corners.end(), [&](int64_t c) { return c >= 0 && c < count; });
}

Result<PolygonSoup> read_ascii(const Head& head, bool wants_colors) {
    Result<PolygonSoup> lines = AsciiReader(head, wants_colors).read_lines();
    if (lines.ok() && has_only_known_corners(lines.value())) return lines;
    Result<PolygonSoup> words = AsciiReader(head, wants_colors).read_words();
    return words.ok() && has_only_known_corners(words.value()) ? words : lines;
}

}  // namespace

bool is_off_keyword(std::string_view word) {
    Head ignored;
    return parse_keyword(word, ignored);
}

Result<TriangleMesh> read_off(std::string_view text, ReadContext& context) {
    const Result<Head> parsed = read_head(text);
    if (!parsed.ok()) return parsed.error();
    const Head& head = parsed.value();
    // In ascii, a vertex takes at least 6 characters, a face at least 4.
    const size_t begin = head.body.offset() + (head.is_binary ? kBinaryCounts : 0);
    const uint64_t room = text.size() - begin + 1;
    const uint64_t vertex_size = head.is_binary ? 12 : 6;
    const uint64_t face_size = head.is_binary ? 8 : 4;
    if (head.vertices > room / vertex_size || head.faces > room / face_size) return too_short(head, text);
    if (Result<void> fits = take_memory(head.vertices, 3 * head.faces, context); !fits.ok()) return fits.error();

    const bool wants_colors = context.textures != nullptr;
    Result<PolygonSoup> soup =
        head.is_binary ? BinaryReader(head, text.substr(begin), wants_colors).read() : read_ascii(head, wants_colors);
    if (!soup.ok()) return soup.error();
    scale_colors(soup.value().vertex_colors);
    scale_colors(soup.value().face_colors);
    return triangulate(std::move(soup.value()), context);
}

}  // namespace gim
