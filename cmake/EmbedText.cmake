# cmake -D OUTPUT=FILE.cpp -D FILES="a;b" -P EmbedText.cmake: writes a table of the files' texts by their names
# (tools/gpu/shader_text.h).
set(entries "")
foreach(file IN LISTS FILES)
    file(READ ${file} text)
    get_filename_component(name ${file} NAME)
    string(APPEND entries "    {\"${name}\", R\"gim_text(${text})gim_text\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"tools/gpu/shader_text.h\"

namespace gim {
namespace {
struct Entry {
    std::string_view name, text;
};
constexpr Entry kEntries[] = {
${entries}};
}  // namespace

std::string_view shader_text(std::string_view name) {
    for (const Entry& entry : kEntries) {
        if (entry.name == name) return entry.text;
    }
    return {};
}
}  // namespace gim
")
