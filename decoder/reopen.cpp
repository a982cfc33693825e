#include "decoder/reopen.h"

namespace gim {

ContainerLimits limits_of(const gim_limits* limits) {
    ContainerLimits l;
    if (limits) l = {limits->max_samples, limits->max_images, limits->max_side};
    return l;
}

Status reopen(const gim_info* info, const void* bytes, size_t size, Header* header) {
    if (!info || (!bytes && size > 0)) return Status::kBadArgument;
    if (Status s = parse_header({static_cast<const uint8_t*>(bytes), size}, limits_of(&info->limits), header);
        s != Status::kOk)
        return s;
    const bool same_file = header->index_size == info->index_size && header->file_size == info->file_size &&
                           header->image_count() == info->image_count && header->kept_levels() == info->level_count;
    return same_file ? Status::kOk : Status::kBadArgument;
}

}  // namespace gim
