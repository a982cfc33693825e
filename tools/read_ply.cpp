// PLY: ascii, binary_little_endian, binary_big_endian, with any property types. Skips unknown elements and properties.
// Reads the faces' vertex_indices (or vertex_index), or the strips of a tristrips element. If colours are wanted, also
// red, green, blue of the vertices or else of the faces, and texture coordinates of vertices (u v, s t, texture_u texture_v) or of face
// corners (texcoord, texnumber) for the images that "comment TextureFile" names. If shading is wanted, also nx, ny, nz of
// the vertices.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "tools/mesh_read.h"
#include "tools/ply_body.h"
#include "tools/polygons.h"
#include "tools/text_scanner.h"

namespace gim {
namespace {

using namespace ply;

int64_t as_index(double value) {
    // NaN, fractions and numbers beyond any index become -1, which no vertex has.
    return value >= 0 && value < 9e15 && value == std::floor(value) ? static_cast<int64_t>(value) : -1;
}

// Adds the triangles of strips. -1 begins the next strip. Every second triangle is turned round.
void add_strips(const std::vector<int64_t>& strip, PolygonSoup& soup) {
    size_t begin = 0;
    for (size_t i = 0; i < strip.size(); ++i) {
        if (strip[i] < 0) {
            begin = i + 1;
        } else if (i >= begin + 2) {
            const bool turned = (i - begin) % 2 != 0;
            const std::array<int64_t, 3> face = {strip[turned ? i - 1 : i - 2], strip[turned ? i - 2 : i - 1],
                                                 strip[i]};
            soup.add_face(face);
        }
    }
}

enum class Role { kNone, kX, kY, kZ, kRed, kGreen, kBlue, kU, kV, kTexture, kNormalX, kNormalY, kNormalZ };
constexpr size_t kRoles = static_cast<size_t>(Role::kNormalZ) + 1;

Role role_of(std::string_view name, bool is_vertex, bool wants_colors) {
    struct Entry {
        std::string_view name;
        Role role;
    };
    static constexpr std::array<Entry, 12> kVertexRoles = {{{"x", Role::kX},
                                                            {"y", Role::kY},
                                                            {"z", Role::kZ},
                                                            {"u", Role::kU},
                                                            {"v", Role::kV},
                                                            {"s", Role::kU},
                                                            {"t", Role::kV},
                                                            {"texture_u", Role::kU},
                                                            {"texture_v", Role::kV},
                                                            {"nx", Role::kNormalX},
                                                            {"ny", Role::kNormalY},
                                                            {"nz", Role::kNormalZ}}};
    static constexpr std::array<Entry, 9> kColorRoles = {{{"red", Role::kRed},
                                                          {"green", Role::kGreen},
                                                          {"blue", Role::kBlue},
                                                          {"diffuse_red", Role::kRed},
                                                          {"diffuse_green", Role::kGreen},
                                                          {"diffuse_blue", Role::kBlue},
                                                          {"r", Role::kRed},
                                                          {"g", Role::kGreen},
                                                          {"b", Role::kBlue}}};
    for (const Entry& entry : kColorRoles) {
        if (wants_colors && equals_ignoring_case(name, entry.name)) return entry.role;
    }
    if (!is_vertex) return wants_colors && name == "texnumber" ? Role::kTexture : Role::kNone;
    for (const Entry& entry : kVertexRoles) {
        const bool is_color = entry.role > Role::kZ && entry.role < Role::kNormalX;
        if (entry.name == name && (wants_colors || !is_color)) return entry.role;
    }
    return Role::kNone;
}

// Maps colours to 0..1. Bytes use the whole range of their type. Of wider types the largest value tells.
void scale_channels(std::vector<std::array<float, 3>>& colors, Scalar type) {
    if (type != Scalar::kU8 && type != Scalar::kI8) return scale_colors(colors);
    for (auto& color : colors) {
        for (float& c : color) {
            if (c < 0) c += 256;                      // "char" holds 128 and more as negative numbers
            c = c > 0 ? std::min(c / 255, 1.0f) : 0;  // a text may hold anything
        }
    }
}

bool has_roles(const std::vector<Role>& roles, std::initializer_list<Role> wanted) {
    return std::all_of(wanted.begin(), wanted.end(),
                       [&](Role r) { return std::count(roles.begin(), roles.end(), r) == 1; });
}

// Adds the texture coordinates of a face's corners, v downwards. All are 0 0 if their number is wrong.
void add_corner_texcoords(const std::vector<float>& uv, size_t corners, PolygonSoup& soup) {
    const bool fits = uv.size() == 2 * corners;
    for (size_t i = 0; i < corners; ++i)
        soup.corner_texcoords.push_back(fits ? std::array<float, 2>{uv[2 * i], 1 - uv[2 * i + 1]}
                                             : std::array<float, 2>{});
}

// Reads the textures that the header names, and completes the soup's texture coordinates.
void add_textures(const Header& header, const std::vector<std::array<float, 2>>& vertex_texcoords,
                  const std::vector<uint32_t>& face_texture, Textures& textures, PolygonSoup& soup) {
    std::vector<uint32_t> loaded;
    for (const std::string_view name : header.textures) loaded.push_back(textures.load(name));
    for (const uint32_t t : face_texture) soup.face_texture.push_back(t == Textures::kNoTexture ? t : loaded[t]);
    if (vertex_texcoords.empty()) return;
    soup.corner_texcoords.clear();
    for (const int64_t v : soup.corners) {
        const bool known = v >= 0 && static_cast<size_t>(v) < vertex_texcoords.size();
        soup.corner_texcoords.push_back(known ? vertex_texcoords[static_cast<size_t>(v)] : std::array<float, 2>{});
    }
}

// Which properties of an element the mesh takes.
struct Columns {
    bool is_vertex = false, is_face = false, is_strip = false;
    bool has_position = false, has_texcoords = false, has_normals = false;  // of vertices
    bool has_colors = false;                                                // of vertices or faces
    Scalar color_type = Scalar::kNone;
    std::vector<Role> roles;  // per property; kNone for lists
};

Columns columns_of(const Element& element, bool wants_colors) {
    Columns columns;
    columns.is_vertex = element.name == "vertex";
    columns.is_face = element.name == "face";
    columns.is_strip = element.name == "tristrips";
    for (const Property& property : element.properties) {
        const bool may_have_role = property.count_type == Scalar::kNone && (columns.is_vertex || columns.is_face);
        Role role = may_have_role ? role_of(property.name, columns.is_vertex, wants_colors) : Role::kNone;
        const bool is_color = role >= Role::kRed && role <= Role::kBlue;
        // The first of several colours.
        if (is_color && std::count(columns.roles.begin(), columns.roles.end(), role) > 0) role = Role::kNone;
        if (role == Role::kRed) columns.color_type = property.type;
        columns.roles.push_back(role);
    }
    columns.has_colors = has_roles(columns.roles, {Role::kRed, Role::kGreen, Role::kBlue});
    if (!columns.is_vertex) return columns;
    columns.has_position = has_roles(columns.roles, {Role::kX, Role::kY, Role::kZ});
    columns.has_texcoords = has_roles(columns.roles, {Role::kU, Role::kV});
    columns.has_normals = has_roles(columns.roles, {Role::kNormalX, Role::kNormalY, Role::kNormalZ});
    return columns;
}

// Reads the body, element by element, into a soup.
class Reader {
  public:
    Reader(const Header& header, std::string_view body, Records records, const ReadContext& context)
        : header_(header),
          body_(body, header.encoding, records),
          textures_(context.textures),
          wants_shading_(context.shading) {}

    Result<void> read_all() {
        for (const Element& element : header_.elements) {
            if (least_size(element, header_.encoding) == 0) continue;  // has no properties
            if (Result<void> read = read_element(element); !read.ok()) return read;
        }
        return {};
    }

    // Words that no record took show that the lines have other numbers than the header says.
    bool is_sound() {
        const auto count = static_cast<int64_t>(soup_.positions.size());
        return !body_.has_more_words() &&
               std::all_of(soup_.corners.begin(), soup_.corners.end(), [&](int64_t c) { return c >= 0 && c < count; });
    }

    uint64_t dropped_lines() const { return body_.dropped_lines; }

    Result<TriangleMesh> mesh(ReadContext& context) && {
        if (!has_coordinates_) return Error{Stage::kInput, "its header has no vertices with x, y and z"};
        if (soup_.normals.size() != soup_.positions.size()) soup_.normals.clear();
        if (!textures_) return triangulate(std::move(soup_), context);
        if (soup_.sizes.size() == face_texture_.size())
            add_textures(header_, vertex_texcoords_, face_texture_, *textures_, soup_);
        if (soup_.vertex_colors.size() != soup_.positions.size()) soup_.vertex_colors.clear();
        if (soup_.face_colors.size() != soup_.sizes.size()) soup_.face_colors.clear();
        scale_channels(soup_.vertex_colors, vertex_color_type_);
        scale_channels(soup_.face_colors, face_color_type_);
        return triangulate(std::move(soup_), context);
    }

  private:
    Result<void> read_element(const Element& element) {
        const Columns columns = columns_of(element, textures_ != nullptr);
        if (columns.is_vertex) {
            soup_.positions.reserve(element.count);
            has_coordinates_ = columns.has_position;
            vertex_color_type_ = columns.color_type;
        }
        if (columns.is_face) face_color_type_ = columns.color_type;
        for (uint64_t record = 0; record < element.count; ++record) {
            if (!read_record(element, columns)) {
                const std::string what = body_.wrong_word.empty()
                                             ? "it ends, or has a list that is too long,"
                                             : "it has " + describe_wrong_number(body_.wrong_word) + ", no number,";
                return Error{Stage::kInput, what + " in '" + std::string(element.name.substr(0, 40)) + "' " +
                                                std::to_string(record) + " of " + std::to_string(element.count) +
                                                " (is the file cut short?)"};
            }
            body_.end_record();
            if (columns.is_vertex) keep_vertex(columns);
            if (columns.is_face && columns.has_colors) keep_color(soup_.face_colors);
            if (columns.is_face && !header_.textures.empty() && textures_) keep_face_texture();
        }
        return {};
    }

    // Returns false if the body ends.
    bool read_record(const Element& element, const Columns& columns) {
        values_.fill(0);
        list_.clear();
        texcoords_.clear();
        for (size_t p = 0; p < element.properties.size(); ++p) {
            const Property& property = element.properties[p];
            if (property.count_type == Scalar::kNone) {
                values_[static_cast<size_t>(columns.roles[p])] = body_.next(property.type);
            } else {
                read_list(property, columns);
                if (body_.failed) return false;
            }
        }
        return !body_.failed;
    }

    void read_list(const Property& property, const Columns& columns) {
        const size_t length = body_.next_length(property);
        const bool is_corners = (columns.is_face || columns.is_strip) &&
                                (property.name == "vertex_indices" || property.name == "vertex_index");
        const bool is_texcoord = textures_ && columns.is_face && property.name == "texcoord";
        if (is_corners) list_.clear();
        for (size_t i = 0; i < length; ++i) {
            const double value = body_.next(property.type);
            if (is_corners) list_.push_back(as_index(value));
            if (is_texcoord) texcoords_.push_back(static_cast<float>(value));
        }
        if (body_.failed || !is_corners) return;
        if (columns.is_face) {
            soup_.add_face(list_);
        } else {
            add_strips(list_, soup_);
        }
    }

    double value_of(Role role) const { return values_[static_cast<size_t>(role)]; }

    void keep_color(std::vector<std::array<float, 3>>& colors) const {
        colors.push_back({static_cast<float>(value_of(Role::kRed)), static_cast<float>(value_of(Role::kGreen)),
                          static_cast<float>(value_of(Role::kBlue))});
    }

    void keep_vertex(const Columns& columns) {
        soup_.positions.push_back({value_of(Role::kX), value_of(Role::kY), value_of(Role::kZ)});
        if (columns.has_colors) keep_color(soup_.vertex_colors);
        if (columns.has_normals && wants_shading_) {
            soup_.normals.push_back({static_cast<float>(value_of(Role::kNormalX)),
                                     static_cast<float>(value_of(Role::kNormalY)),
                                     static_cast<float>(value_of(Role::kNormalZ))});
        }
        if (columns.has_texcoords) {
            vertex_texcoords_.push_back(
                {static_cast<float>(value_of(Role::kU)), static_cast<float>(1 - value_of(Role::kV))});
        }
    }

    void keep_face_texture() {
        if (vertex_texcoords_.empty()) add_corner_texcoords(texcoords_, list_.size(), soup_);
        const double number = value_of(Role::kTexture);
        const bool known = number >= 0 && number < static_cast<double>(header_.textures.size());
        face_texture_.push_back(known ? static_cast<uint32_t>(number) : Textures::kNoTexture);
    }

    const Header& header_;
    Body body_;
    Textures* textures_;  // null if colours are not wanted
    bool wants_shading_;
    PolygonSoup soup_;
    std::vector<std::array<float, 2>> vertex_texcoords_;  // v downwards
    std::vector<uint32_t> face_texture_;                  // index into Header::textures
    bool has_coordinates_ = false;
    Scalar vertex_color_type_ = Scalar::kNone, face_color_type_ = Scalar::kNone;

    // The current record.
    std::array<double, kRoles> values_ = {};  // by role
    std::vector<int64_t> list_;               // corners of a face or strip
    std::vector<float> texcoords_;            // of a face
};

// Counts of the header are checked before any memory is taken for them.
Result<void> check_counts(const Header& header, std::string_view text, ReadContext& context) {
    const size_t body_size = text.size() - header.size;
    for (const Element& element : header.elements) {
        const size_t least = least_size(element, header.encoding);
        if (least > 0 && element.count > (body_size + 1) / least) {
            return Error{Stage::kInput, "its header claims " + std::to_string(element.count) + " of '" +
                                            std::string(element.name.substr(0, 40)) + "', but the file holds only " +
                                            std::to_string(text.size()) + " bytes (is it cut short?)"};
        }
        const uint64_t vertices = element.name == "vertex" ? element.count : 0;
        const uint64_t faces = element.name == "face" ? element.count : 0;
        if (least == 0) continue;
        if (Result<void> fits = take_memory(vertices, 3 * faces, context); !fits.ok()) return fits;
    }
    return {};
}

}  // namespace

Result<TriangleMesh> read_ply(std::string_view text, ReadContext& context) {
    const Result<Header> parsed = read_header(text);
    if (!parsed.ok()) return parsed.error();
    const Header& header = parsed.value();
    if (const Result<void> counts = check_counts(header, text, context); !counts.ok()) return counts.error();

    const std::string_view body = text.substr(header.size);
    Reader words(header, body, Records::kWords, context);
    const Result<void> read = words.read_all();
    if (header.encoding != Encoding::kAscii || (read.ok() && words.is_sound())) {
        return read.ok() ? std::move(words).mesh(context) : read.error();
    }
    // Perhaps lines have more numbers than the header says.
    Reader lines(header, body, Records::kLines, context);
    if (!lines.read_all().ok() || lines.dropped_lines() == 0) {
        return read.ok() ? std::move(words).mesh(context) : read.error();
    }
    context.warn(std::to_string(lines.dropped_lines()) +
                 " lines have more numbers than the header says; those at their ends are left out");
    return std::move(lines).mesh(context);
}

}  // namespace gim
