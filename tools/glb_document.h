// A glTF file on its way to a GLB: its JSON, to be changed, and the bytes of its buffer views, old and new.
#pragma once

#include <string>
#include <vector>

#include "tools/gltf_file.h"
#include "tools/gltf_references.h"

namespace gim::gltf {

class GlbDocument {
  public:
    // What is read by ranges comes first in the file.
    enum class Place { kGeometry, kArrays, kPicture, kFallback };

    // Copies the JSON of the file, which must outlive the object.
    explicit GlbDocument(File& file);

    Json root;

    // Each returns the index of what it adds. target: of the view, 0 for none.
    size_t add_view(Bytes bytes, Place place, int target = 0);
    size_t add(List list, Json entry);

    struct Output {
        Bytes glb;
        Bytes fallback;  // empty: no view is a fallback
    };
    // Takes away what nothing uses any more, embeds pictures, decompresses views of meshopt, and writes the GLB. Views of
    // kFallback come to a second buffer with this URI. Throws a Failure. Call it once.
    Output finish(const std::string& fallback_uri);

  private:
    struct Data {
        Bytes own;
        bool is_own = false;
        uint64_t source = 0;  // of the file's views
        Place place = Place::kArrays;
    };
    void embed_pictures();
    void drop_what_is_unused();
    void lay_out(Output& output, const std::string& fallback_uri);
    std::span<const uint8_t> bytes_of(const Data& data);

    File& file_;
    std::vector<Data> views_;
    std::vector<std::vector<bool>> used_before_;  // of each list
};

}  // namespace gim::gltf
