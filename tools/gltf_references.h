// Who uses whom in a glTF file: finds the indices in its JSON, and takes away what nothing uses any more.
#pragma once

#include <functional>
#include <vector>

#include "tools/gltf_json.h"

namespace gim::gltf {

// Lists whose entries others name by index. Each list is used only by those before it.
enum class List { kMaterials, kTextures, kImages, kAccessors, kBufferViews };
inline constexpr List kAllLists[] = {List::kMaterials, List::kTextures, List::kImages, List::kAccessors,
                                     List::kBufferViews};
const char* name_of(List list);

// Calls use() for every whole number in the JSON that is an index into the list.
void for_each_reference(Json& root, List list, const std::function<void(Json&)>& use);

// Returns for each entry of the list whether something uses it.
std::vector<bool> used_entries(Json& root, List list);

// Whether all references are known: no extension may hold others.
bool may_renumber(const Json& root);

// Takes away the entries that were used before and are not any more, and gives the others new indices. Entries beyond
// `used_before` are new. Returns the old index of each entry that stays.
std::vector<size_t> drop_unused(Json& root, List list, const std::vector<bool>& used_before);

// Takes a name out of extensionsUsed and extensionsRequired; and adds it.
void forget_extension(Json& root, const std::string& name);
void declare_extension(Json& root, const std::string& name, bool required);

}  // namespace gim::gltf
