#include "tools/foreign_format.h"

#include <algorithm>
#include <array>

namespace gim {
namespace {

using namespace std::string_view_literals;

constexpr size_t kSniffed = size_t{1} << 12;

struct Signature {
    std::string_view begins;
    std::string_view name;
};

constexpr std::array<Signature, 25> kMeshes = {{{"Kaydara FBX Binary"sv, "an FBX file"sv},
                                                {"; FBX"sv, "an FBX file"sv},
                                                {"ISO-10303-21"sv, "a STEP file"sv},
                                                {"Ogawa"sv, "an Alembic file"sv},
                                                {"\x89HDF\r\n"sv, "an HDF5 (Alembic?) file"sv},
                                                {"BLENDER"sv, "a Blender file"sv},
                                                {"PXR-USDC"sv, "a USD file"sv},
                                                {"#usda"sv, "a USD file"sv},
                                                {"#VRML"sv, "a VRML file"sv},
                                                {"#X3D"sv, "an X3D file"sv},
                                                {"# vtk DataFile"sv, "a VTK file"sv},
                                                {"DRACO"sv, "a Draco file"sv},
                                                {"OCTM"sv, "an OpenCTM file"sv},
                                                {"3D Geometry File Format"sv, "a Rhino file"sv},
                                                {"MeshVersionFormatted"sv, "a Medit file"sv},
                                                {"$MeshFormat"sv, "a Gmsh file"sv},
                                                {"AutoCAD Binary DXF"sv, "a DXF file"sv},
                                                {"xof 0"sv, "a DirectX file"sv},
                                                {"AC3D"sv, "an AC3D file"sv},
                                                {"MD2"sv, "an MD2 model"sv},
                                                {"MMDl"sv, "a 3DMF file"sv},
                                                {"U3D\0"sv, "a U3D file"sv},
                                                {"# .PCD"sv, "a PCD point cloud"sv},
                                                {"LASF"sv, "a LAS point cloud"sv},
                                                {"ASTM-E57"sv, "an E57 point cloud"sv}}};

constexpr std::array<Signature, 7> kPacked = {{{"\x1F\x8B"sv, "packed with gzip"sv},
                                               {"BZh"sv, "packed with bzip2"sv},
                                               {"\xFD"
                                                "7zXZ"sv,
                                                "packed with xz"sv},
                                               {"\x28\xB5\x2F\xFD"sv, "packed with zstd"sv},
                                               {"7z\xBC\xAF\x27\x1C"sv, "a 7z archive"sv},
                                               {"Rar!"sv, "a RAR archive"sv},
                                               {"PK\x05\x06"sv, "an empty ZIP archive"sv}}};

constexpr std::array<Signature, 6> kOthers = {
    {{"\x89PNG"sv, "it is a PNG picture and no mesh"sv},
     {"\xFF\xD8\xFF"sv, "it is a JPEG picture and no mesh"sv},
     {"%PDF"sv, "it is a PDF and no mesh"sv},
     {"SQLite format 3"sv, "it is a database and no mesh"sv},
     {"\x7F"
      "ELF"sv,
      "it is a program and no mesh"sv},
     {"version https://git-lfs"sv, "it is a pointer of Git LFS and not the file itself; run: git lfs pull"sv}}};

std::string export_advice(std::string_view name) {
    return "it is " + std::string(name) + "; export it as PLY, OBJ, STL or GLB";
}

template <size_t N>
std::string_view find(const std::array<Signature, N>& signatures, std::string_view text) {
    for (const Signature& signature : signatures) {
        if (text.starts_with(signature.begins)) return signature.name;
    }
    return {};
}

// The names of an archive's files stand in it as they are.
std::string describe_zip(std::string_view text) {
    if (text.find("3D/3dmodel.model") != std::string_view::npos) return export_advice("a 3MF file");
    const std::string_view first = text.substr(std::min<size_t>(text.size(), 30), 200);
    for (const std::string_view part : {".usdc", ".usda", ".usd"}) {
        if (first.find(part) != std::string_view::npos) return export_advice("a USDZ file");
    }
    if (text.find("doc.kml") != std::string_view::npos) return export_advice("a KMZ file");
    if (text.find("Document.xml") != std::string_view::npos) return export_advice("a FreeCAD file");
    return "it is a ZIP archive; unpack it";
}

std::string describe_xml(std::string_view text) {
    static constexpr std::array<Signature, 8> kRoots = {{{"<COLLADA"sv, "a Collada file"sv},
                                                         {"<X3D"sv, "an X3D file"sv},
                                                         {"<VTKFile"sv, "a VTK file"sv},
                                                         {"<amf"sv, "an AMF file"sv},
                                                         {"<model"sv, "the model of a 3MF file"sv},
                                                         {"<kml"sv, "a KML file"sv},
                                                         {"<robot"sv, "a URDF file"sv},
                                                         {"<mesh"sv, "an XML mesh"sv}}};
    for (const Signature& root : kRoots) {
        if (text.find(root.begins) != std::string_view::npos) return export_advice(root.name);
    }
    if (text.find("<html") != std::string_view::npos || text.find("<HTML") != std::string_view::npos ||
        text.find("<!DOCTYPE html") != std::string_view::npos) {
        return "it is a web page and not the mesh; download the file itself";
    }
    return export_advice("an XML file");
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

bool is_wide_text(std::string_view text) {
    const bool has_mark =
        text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") || text.starts_with("\0\0\xFE\xFF"sv);
    if (has_mark) return true;
    // Letters of ASCII as 16 bits: every second byte is zero, the others are printable.
    constexpr size_t kLetters = 8;
    for (const size_t zero : {size_t{0}, size_t{1}}) {
        size_t found = 0;
        while (found < kLetters && 2 * found + 1 < text.size()) {
            const char letter = text[2 * found + 1 - zero];
            const bool is_letter = (letter >= ' ' && letter <= '~') || letter == '\n' || letter == '\r';
            if (text[2 * found + zero] != '\0' || !is_letter) break;
            ++found;
        }
        if (found == kLetters) return true;
    }
    return false;
}

std::string describe_foreign_format(std::string_view text) {
    if (text.starts_with("PK\x03\x04")) return describe_zip(text);
    if (const std::string_view name = find(kMeshes, text); !name.empty()) return export_advice(name);
    if (const std::string_view name = find(kPacked, text); !name.empty()) {
        return "it is " + std::string(name) + "; unpack it first";
    }
    if (const std::string_view what = find(kOthers, text); !what.empty()) return std::string(what);
    const std::string_view head = text.substr(0, kSniffed);
    const size_t begin = std::min(head.find_first_not_of(" \t\r\n"), head.size());
    return head.substr(begin).starts_with('<') ? describe_xml(head) : std::string();
}

}  // namespace gim
